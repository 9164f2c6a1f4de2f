"""Conversion of .msg files to .idl files."""

from __future__ import annotations

from pathlib import Path

from .idl import MSG_TYPE_TO_IDL as MSG_TYPE_TO_IDL
from .idl import convert
from .idl import get_idl_type as get_idl_type
from .idl import get_include_file as get_include_file
from .idl import string_to_idl_string_literal as string_to_idl_string_literal
from .idl import to_idl_literal as to_idl_literal


def convert_msg_to_idl(package_dir: Path, package_name: str, input_file: Path, output_dir: Path) -> Path:
    """Write the .idl file of a .msg file and return its path.

    Parameters
    ----------
    package_dir
        The package's folder, absolute.
    package_name
        The package's name.
    input_file
        The file, relative to `package_dir`.
    output_dir
        Folder to write to.
    """
    return convert("msg", package_dir, package_name, input_file, output_dir)
