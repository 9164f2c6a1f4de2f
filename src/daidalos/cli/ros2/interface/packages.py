"""`ros2 interface packages`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.interface_arguments import add_kind_arguments, wanted


class PackagesVerb(Verb):
    """Output a list of packages that provide interfaces."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_kind_arguments(parser, "packages that generate {}s")

    def main(self, *, args: Namespace) -> Status:
        """Print their names."""
        from rosidl_runtime_py import get_interfaces

        for package in sorted(wanted(get_interfaces(), args.kind)):
            print(package)
        return 0
