"""Command `rosidl generate`."""

from __future__ import annotations

import argparse

from rosidl_cli.command import Command, add_file_arguments
from rosidl_cli.command.generate.api import generate


class GenerateCommand(Command):
    """Generate source code from interface definition files."""

    name = "generate"

    def add_arguments(self, parser: argparse.ArgumentParser) -> None:
        """Declare what to generate, from which files and where."""
        parser.add_argument(
            "-t", "--type", metavar="TYPE", dest="types", action="append", default=[],
            help="Language of the classes, such as 'py'; may be repeated. Default: all that are installed.",
        )  # fmt: skip
        parser.add_argument(
            "-ts", "--type-support", metavar="TYPESUPPORT", dest="typesupports", action="append", default=[],
            help="Support code of a middleware; may be repeated.",
        )  # fmt: skip
        add_file_arguments(parser, "source files")

    def main(self, *, args: argparse.Namespace) -> None:
        """Generate the code."""
        generate(
            package_name=args.package_name,
            interface_files=args.interface_files,
            include_paths=args.include_paths,
            output_path=args.output_path,
            types=args.types,
            typesupports=args.typesupports,
        )
