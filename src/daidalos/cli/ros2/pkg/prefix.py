"""`ros2 pkg prefix`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from daidalos.cli.ros2.completion import complete_packages
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.packages import package_prefix


class PrefixVerb(Verb):
    """Output the prefix path of a package."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        complete_packages(parser.add_argument("package_name", help="The package name"))
        parser.add_argument(
            "--share", action="store_true", help="Show share directory for the package instead of prefix path"
        )

    def main(self, *, args: Namespace) -> Status:
        """Print the prefix."""
        prefix = package_prefix(args.package_name)
        print(prefix / "share" / args.package_name if args.share else prefix)
        return 0
