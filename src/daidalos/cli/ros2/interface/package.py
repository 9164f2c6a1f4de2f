"""`ros2 interface package`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from daidalos.cli.ros2.completion import complete_packages
from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.interface_arguments import add_kind_arguments, wanted
from daidalos.common.suggestions import did_you_mean


class PackageVerb(Verb):
    """Output a list of available interface types within one package."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_kind_arguments(parser, "{} types of the package")
        complete_packages(
            parser.add_argument("package_name", help="Name of the ROS package (e.g. 'example_interfaces')")
        )

    def main(self, *, args: Namespace) -> Status:
        """Print the names."""
        from rosidl_runtime_py import get_interface_packages, get_interfaces

        try:
            found = get_interfaces([args.package_name])
        except LookupError as error:
            raise CliError(f"{error}{did_you_mean(args.package_name, get_interface_packages())}") from None
        if not found:
            raise CliError(f"package '{args.package_name}' defines no interfaces")
        for package, names in wanted(found, args.kind).items():
            for name in sorted(names):
                print(f"{package}/{name}")
        return 0
