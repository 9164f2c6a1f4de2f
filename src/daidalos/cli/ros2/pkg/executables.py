"""`ros2 pkg executables`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from daidalos.cli.ros2.completion import complete_packages
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.packages import package_names, package_prefix


class ExecutablesVerb(Verb):
    """Output a list of package specific executables."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        complete_packages(parser.add_argument("package_name", nargs="?", help="Name of the package"))
        parser.add_argument("--full-path", action="store_true", help="Show the path of the executables")

    def main(self, *, args: Namespace) -> Status:
        """Print the executables of one package or of all."""
        from daidalos.workspaces.executables import executable_path, executables, is_known

        name = args.package_name
        if name and not is_known(name):
            package_prefix(name)
        for package in [name] if name else package_names():
            for executable in executables(package):
                print(executable_path(package, executable) if args.full_path else f"{package} {executable}")
        return 0
