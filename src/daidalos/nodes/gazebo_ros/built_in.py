"""Worlds and robots by name: those of a file, or the built-in ones."""

from __future__ import annotations

from pathlib import Path

from daidalos.common.errors import UserError
from daidalos.common.suggestions import hint
from daidalos.interfaces.library import BUILT_IN


def find_world_file(name: str) -> Path:
    """Return the file of a world, by its path or the name of a built-in one.

    Raises
    ------
    UserError
        With similar names.
    """
    return _find(name, {file.stem: file for file in sorted(BUILT_IN.glob("*/worlds/*.world"))}, "world file")


def find_model_file(name: str) -> Path:
    """Return the file of a robot or model, by its path or the name of a built-in robot.

    Raises
    ------
    UserError
        With similar names.
    """
    folder = BUILT_IN / "turtlebot3_description" / "urdf"
    known = {robot: folder / f"turtlebot3_{robot}.urdf.xacro" for robot in ("burger", "waffle")}
    return _find(name, known, "robot or model file")


def _find(name: str, known: dict[str, Path], kind: str) -> Path:
    path = Path(name)
    if path.is_file():
        return path.resolve()
    if name not in known:
        raise UserError(f"there is no {kind} '{name}'{hint(name, known)}")
    return known[name]
