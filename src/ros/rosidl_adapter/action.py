"""Conversion of .action files to .idl files."""

from __future__ import annotations

from pathlib import Path

from .idl import convert


def convert_action_to_idl(package_dir: Path, package_name: str, input_file: Path, output_dir: Path) -> Path:
    """Write the .idl file of a .action file and return its path.

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
    return convert("action", package_dir, package_name, input_file, output_dir)
