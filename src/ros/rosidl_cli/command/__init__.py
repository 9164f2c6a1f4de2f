"""Commands of `rosidl`."""

from __future__ import annotations

import argparse
from pathlib import Path


class Command:
    """Command of `rosidl`."""

    name = ""

    def add_arguments(self, parser: argparse.ArgumentParser) -> None:
        """Declare the command's arguments."""

    def main(self, *, args: argparse.Namespace) -> None:
        """Run the command."""
        raise NotImplementedError


def add_file_arguments(parser: argparse.ArgumentParser, output: str) -> None:
    """Declare the arguments of commands that read interface files and write others.

    Parameters
    ----------
    parser
        The command's parser.
    output
        What is written.
    """
    parser.add_argument(
        "-o", "--output-path", metavar="PATH", type=Path, help=f"Folder for the {output}; default: '.'."
    )
    parser.add_argument(
        "-I", "--include-path", metavar="PATH", type=Path, dest="include_paths", action="append", default=[],
        help="Folder with the interface files of packages that are referred to, such as an installation's 'share'.",
    )  # fmt: skip
    parser.add_argument("package_name", help="Name of the package that the interface files belong to")
    parser.add_argument(
        "interface_files",
        metavar="interface_file",
        nargs="+",
        help="Interface file relative to the package, such as 'msg/Num.msg'; after a folder and a colon, to that one.",
    )
