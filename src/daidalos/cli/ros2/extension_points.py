"""`ros2 extension_points`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from daidalos.cli.ros2.extension import Command, Status
from daidalos.cli.ros2.extensions import add_list_arguments


class ExtensionPointsCommand(Command):
    """List extension points."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_list_arguments(parser, "extension points")

    def main(self, *, parser: ArgumentParser, args: Namespace) -> Status:
        """Print the entry point groups of commands and verbs."""
        from daidalos.cli.ros2.groups import groups

        for group, extensions in groups().items():
            print(group)
            if args.verbose:
                print(f"  extensions: {len(extensions)}")
        return 0
