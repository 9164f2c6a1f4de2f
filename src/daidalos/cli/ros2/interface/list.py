"""`ros2 interface list`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.interface_arguments import KINDS, add_kind_arguments, wanted


class ListVerb(Verb):
    """List all interface types available."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_kind_arguments(parser, "{} types")

    def main(self, *, args: Namespace) -> Status:
        """Print the names by type."""
        from rosidl_runtime_py import get_interfaces

        found = get_interfaces()
        for kind in [args.kind] if args.kind else KINDS:
            print(f"{KINDS[kind]}:")
            for package, names in sorted(wanted(found, kind).items()):
                for name in sorted(names):
                    print(f"    {package}/{name}")
        return 0
