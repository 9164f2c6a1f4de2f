"""`ros2 component types`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from daidalos.cli.ros2.completion import complete_packages
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.packages import package_prefix


class TypesVerb(Verb):
    """Output a list of components registered in the ament index."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        complete_packages(
            parser.add_argument("package_name", nargs="?", help="Package name to look up for registered components")
        )

    def main(self, *, args: Namespace) -> Status:
        """Print the components of one package, or of all packages."""
        from daidalos.nodes.extensions import components, packages

        if not args.package_name:
            for package in packages():
                print(package)
                for name in components(package):
                    print(f"  {name}")
            return 0
        found = components(args.package_name)
        if not found:
            package_prefix(args.package_name)
            return f"No component types registered in package '{args.package_name}'"
        for name in found:
            print(name)
        return 0
