"""Robot and model descriptions in files that a user names."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from daidalos.nodes.packages import package_share
from daidalos.nodes.runner import UserError

if TYPE_CHECKING:
    from daidalos.description.robot import Robot
    from daidalos.description.world import Model


def read_description(path: Path) -> str:
    """Return the URDF or SDF text of a file; a ``.xacro`` file is expanded.

    Raises
    ------
    UserError
        When the file cannot be read or expanded, or expands to what is no robot.
    """
    if path.suffix == ".xacro":
        return _expanded(path)
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise UserError(f"cannot read '{path}': {error.strerror}") from None
    except UnicodeDecodeError:
        raise UserError(f"'{path}' is not a text file") from None


def _expanded(path: Path) -> str:
    from daidalos.description.errors import DescriptionError
    from daidalos.description.urdf import read_robot
    from daidalos.description.xacro import expand

    try:
        root = expand(path, resolve=package_share)
        if root.tag == "robot":
            read_robot(root, package_share)  # the lines of faults are still those of the file
    except DescriptionError as error:
        raise UserError(str(error)) from None
    return '<?xml version="1.0"?>\n' + root.to_text()


def parse_description(text: str, source: str = "robot_description") -> Robot | Model:
    """Read a robot in URDF, or a model in SDF.

    Raises
    ------
    UserError
        When it is faulty; names `source`.
    """
    from daidalos.description.errors import DescriptionError

    try:
        if "<sdf" in text[:2000]:
            from daidalos.description import sdf

            return sdf.parse_model(text, source, package_share)
        from daidalos.description import urdf

        return urdf.parse(text, source, package_share)
    except DescriptionError as error:
        raise UserError(str(error)) from None
