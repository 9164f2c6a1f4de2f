"""Descriptions of robots and models in files that a user names."""

from __future__ import annotations

from pathlib import Path

from daidalos.nodes.packages import package_share
from daidalos.nodes.runner import UserError


def read_description(path: Path) -> str:
    """Return the URDF or SDF text of a file; a ``.xacro`` file is expanded.

    Raises
    ------
    UserError
        When the file cannot be read or expanded.
    """
    if path.suffix == ".xacro":
        from daidalos.description.errors import DescriptionError
        from daidalos.description.xacro import load_xacro

        try:
            return load_xacro(path, resolve=package_share)
        except DescriptionError as error:
            raise UserError(str(error)) from None
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise UserError(f"cannot read '{path}': {error.strerror}") from None
    except UnicodeDecodeError:
        raise UserError(f"'{path}' is not a text file") from None
