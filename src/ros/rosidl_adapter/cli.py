"""Translators of .msg, .srv and .action files to .idl files."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from xml.etree import ElementTree

from rosidl_cli.command.helpers import interface_path_as_tuple
from rosidl_cli.command.translate.extensions import TranslateCommandExtension

from .action import convert_action_to_idl
from .msg import convert_msg_to_idl
from .srv import convert_srv_to_idl

Conversion = Callable[[Path, str, Path, Path], Path]
"""Conversion of the file of a package folder to an output folder; see `convert_msg_to_idl`."""


def convert_files_to_idl(extension: str, conversion_function: Conversion, argv: Sequence[str] | None = None) -> int:
    """Write the .idl files of interface files beside them, and return the exit status.

    Parameters
    ----------
    extension
        Suffix of the files, such as ``.msg``.
    conversion_function
        What converts one.
    argv
        The program's arguments: the files.
    """
    parser = argparse.ArgumentParser(description=f"Convert {extension} files to .idl")
    parser.add_argument("interface_files", nargs="+", type=Path, help="The interface files to convert")
    status = 0
    for file in parser.parse_args(argv).interface_files:
        folder = next((one for one in file.absolute().parents if (one / "package.xml").is_file()), None)
        if folder is None:
            print(f"Could not find package for '{file}'", file=sys.stderr)  # noqa: T201
            status = 1
            continue
        package = ElementTree.parse(folder / "package.xml").getroot().findtext("name", "").strip()
        conversion_function(folder, package, file.absolute().relative_to(folder), file.parent)
    return status


class TranslateToIDL(TranslateCommandExtension):
    """Translator to .idl files."""

    output_format = "idl"

    @property
    def conversion_function(self) -> Conversion:
        """Function that converts one file."""
        raise NotImplementedError

    def translate(
        self, package_name: str, interface_files: list[str], include_paths: list[str], output_path: Path
    ) -> list[str]:
        """Write the .idl files; see `TranslateCommandExtension.translate`."""
        written = []
        for prefix, path in map(interface_path_as_tuple, interface_files):
            file = self.conversion_function(prefix, package_name, path, output_path / path.parent)
            written.append(f"{output_path}:{file.relative_to(output_path).as_posix()}")
        return written


class TranslateMsgToIDL(TranslateToIDL):
    """Translator of .msg files."""

    input_format = "msg"

    @property
    def conversion_function(self) -> Conversion:
        """Function that converts one file."""
        return convert_msg_to_idl


class TranslateSrvToIDL(TranslateToIDL):
    """Translator of .srv files."""

    input_format = "srv"

    @property
    def conversion_function(self) -> Conversion:
        """Function that converts one file."""
        return convert_srv_to_idl


class TranslateActionToIDL(TranslateToIDL):
    """Translator of .action files."""

    input_format = "action"

    @property
    def conversion_function(self) -> Conversion:
        """Function that converts one file."""
        return convert_action_to_idl
