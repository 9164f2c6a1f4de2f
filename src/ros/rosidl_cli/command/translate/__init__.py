"""Command `rosidl translate`."""

from __future__ import annotations

import argparse

from rosidl_cli.command import Command, add_file_arguments
from rosidl_cli.command.translate.api import translate


class TranslateCommand(Command):
    """Translate interface definition files from one format to another."""

    name = "translate"

    def add_arguments(self, parser: argparse.ArgumentParser) -> None:
        """Declare the formats, the files and where to write."""
        parser.add_argument(
            "--use", "--translator", metavar="TRANSLATOR", dest="translators", action="append", default=[],
            help="Translator to use, such as 'msg2idl'; may be repeated. Default: all that are installed.",
        )  # fmt: skip
        parser.add_argument(
            "--to", "--output-format", metavar="FORMAT", dest="output_format", required=True, help="Format to write."
        )
        parser.add_argument(
            "--from", "--input-format", metavar="FORMAT", dest="input_format",
            help="Format of the files; default: what each one's name ends in.",
        )  # fmt: skip
        add_file_arguments(parser, "translated files")

    def main(self, *, args: argparse.Namespace) -> None:
        """Translate the files."""
        translate(
            package_name=args.package_name,
            interface_files=args.interface_files,
            output_format=args.output_format,
            input_format=args.input_format,
            include_paths=args.include_paths,
            output_path=args.output_path,
            translators=args.translators,
        )
