"""`ros2 extensions`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2cli.extensions import Extensions

from daidalos.cli.ros2.extension import Command, Status
from daidalos.common.extensions import BUILT_IN


class ExtensionsCommand(Command):
    """List extensions."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_list_arguments(parser, "extensions")

    def main(self, *, parser: ArgumentParser, args: Namespace) -> Status:
        """Print the extensions of every group."""
        from daidalos.cli.ros2.groups import groups

        for group, extensions in groups().items():
            if not extensions and not args.all:
                continue
            print(group)
            for name in extensions:
                print(f"  {name}: {extensions.describe(name)}")
                if args.verbose:
                    print(f"    from: {_origin(extensions, name)}")
        return 0


def _origin(extensions: Extensions, name: str) -> str:
    extension = extensions.extension(name)
    return "daidalos" if extension.origin == BUILT_IN else f"{extension.origin} ({extension.target})"


def add_list_arguments(parser: ArgumentParser, what: str) -> None:
    """Declare the arguments shared with `ros2 extension_points`."""
    parser.add_argument("--all", "-a", action="store_true", help=f"Also show empty {what}")
    parser.add_argument("--verbose", "-v", action="store_true", help=f"Show more information for each of the {what}")
