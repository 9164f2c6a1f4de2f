"""Descriptions of .msg, .srv and .action files and their conversion to .idl files, under rosidl's names."""

from __future__ import annotations

from pathlib import Path


def convert_to_idl(package_dir: Path, package_name: str, interface_file: Path, output_dir: Path) -> Path:
    """Write the .idl file of an interface file of a package and return its path.

    Parameters
    ----------
    package_dir
        The package's folder, absolute.
    package_name
        The package's name.
    interface_file
        The .msg, .srv or .action file, relative to `package_dir`.
    output_dir
        Folder whose ``msg``, ``srv`` or ``action`` folder the file goes to.

    Raises
    ------
    ValueError
        For a file of another kind.
    """
    from .idl import convert

    kind = interface_file.suffix[1:]
    return convert(kind, package_dir, package_name, interface_file, output_dir / kind)
