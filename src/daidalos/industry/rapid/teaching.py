"""Guided calibration of tools and work objects: which points to touch, and the result as data in RAPID."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from daidalos.common.errors import UserError
from daidalos.industry.calibration import (
    CalibrationError,
    ToolCalibration,
    calibrate_tool,
    tool_rotation,
    work_object_deviations,
    work_object_frame,
    work_object_warnings,
)
from daidalos.industry.rapid import tree
from daidalos.industry.rapid.parsing import parse
from daidalos.industry.rapid.sources import Source, read_source, write_source

Array = NDArray[np.float64]
Method = Literal["tcp", "z", "zx"]
TOUCH_NOISE = 3e-4
"""Deviation of each coordinate of a touch by eye [m]; work objects have no redundancy that would tell it."""

MOST_POINTS = 20
FEWEST_POINTS = 4
_ELONGATORS = {"tcp": (), "z": ("z",), "zx": ("z", "x")}


@dataclass(frozen=True)
class Result:
    """Data in RAPID, and how good it is.

    Attributes
    ----------
    declaration
        A declaration of PERS data.
    lines
        What the operator is told: values, deviations.
    warnings
        What makes the result doubtful.
    """

    declaration: str
    lines: list[str]
    warnings: list[str]


def tool_prompts(points: int, method: Method) -> list[str]:
    """Return what to do for each pose of a tool's calibration."""
    touches = [
        f"touch the fixed point with the tip, in another orientation ({i} of {points})" for i in range(1, points + 1)
    ]
    touches[0] = f"touch the fixed point with the tip of the tool (1 of {points})"
    axes = [f"move the tool so that the fixed point is on its positive {axis} axis" for axis in _ELONGATORS[method]]
    return touches + axes


def work_object_prompts() -> list[str]:
    """Return what to do for each pose of a work object's calibration."""
    return ["touch x1, a point on the x axis", "touch x2, farther along the x axis", "touch y1, a point on the y axis"]


def teach_tool(name: str, poses: Sequence[Array], method: Method, mass: float = 1.0) -> Result:
    """Return a tool from poses of the flange (4, 4) [m] in the order of `tool_prompts`.

    Raises
    ------
    CalibrationError
        Where the poses do not determine it.
    """
    axes = _ELONGATORS[method]
    touches, rest = list(poses[: len(poses) - len(axes)]), list(poses[len(poses) - len(axes) :])
    if len(touches) < FEWEST_POINTS:
        raise CalibrationError(f"{len(touches)} touches are too few: at least {FEWEST_POINTS}")
    found = calibrate_tool([one[:3, 3] for one in touches], [one[:3, :3] for one in touches])
    rotation = np.eye(3)
    if rest:
        rotation = tool_rotation(found, *((one[:3, 3], one[:3, :3]) for one in rest))
    offset, turned = 1e3 * found.offset, _quaternion(rotation)
    value = f"[TRUE,[{_list(offset, 3)},{_list(turned, 6)}],[{mass:g},[0,0,1],[1,0,0,0],0,0,0]]"
    return Result(f"PERS tooldata {name}:={value};", _tool_lines(found), found.warnings())


def _tool_lines(found: ToolCalibration) -> list[str]:
    deviation = 1e3 * found.deviation
    root = 1e6 * found.covariance
    return [
        f"tip in the flange: {_list(1e3 * found.offset, 3)} mm",
        f"deviation: {_list(deviation, 3)} mm; touches apart by {1e3 * found.residual_m:.3f} mm rms; "
        f"condition {found.condition:.1f}",
        f"covariance [mm^2]: {'; '.join(_list(row, 4) for row in root)}",
    ]


def teach_work_object(name: str, poses: Sequence[Array], tool: Array, noise: float = TOUCH_NOISE) -> Result:
    """Return a work object from three poses of the flange (4, 4) [m], and the tool (4, 4) that touched.

    Raises
    ------
    CalibrationError
        Where the points do not determine it.
    """
    x1, x2, y1 = ((one @ tool)[:3, 3] for one in poses)
    frame = work_object_frame(x1, x2, y1)
    origin, rotation = work_object_deviations(x1, x2, y1, noise)
    turned = np.degrees(np.sqrt(np.diag(rotation)))
    lines = [
        f"origin: {_list(1e3 * frame[:3, 3], 3)} mm",
        f"deviation, with {1e3 * noise:g} mm a touch: {_list(1e3 * np.sqrt(np.diag(origin)), 3)} mm, "
        f"{_list(turned, 3)} deg about x, y, z of the base",
    ]
    at = f"[{_list(1e3 * frame[:3, 3], 3)},{_list(_quaternion(frame[:3, :3]), 6)}]"
    value = f'[FALSE,TRUE,"",{at},[[0,0,0],[1,0,0,0]]]'
    return Result(f"PERS wobjdata {name}:={value};", lines, work_object_warnings(x1, x2, y1))


def save(result: Result, path: Path, replaces: bool) -> str:
    """Write the data into a module: a new one, behind the data of an old one, or in the place of data of that name.

    Returns
    -------
    str
        What was done.

    Raises
    ------
    UserError
        Where the module declares the name already and it may not be replaced, or cannot be written.
    """
    _, type_, name = result.declaration.partition(":=")[0].split()
    if not path.exists():
        module = "".join(one if one.isascii() and one.isalnum() else "_" for one in path.stem)
        module = module if module[:1].isalpha() else f"m_{module}"
        write_source(path, f"MODULE {module[:32]}\n  {result.declaration}\nENDMODULE\n", "utf-8")
        return f"wrote {path}"
    source = read_source(path)
    parsed = parse(source)
    if parsed.problems or not parsed.tree.modules:
        raise UserError(f"{path}: has syntax errors; daidalos rapid check lists them")
    module_node = parsed.tree.modules[0]
    data = [one for one in module_node.items if isinstance(one, tree.Data)]
    old = next((one for one in data if one.name.key == name.lower()), None)
    if old is None:
        place = data[-1].end if data else module_node.items[0].start if module_node.items else None
        if place is None:
            raise UserError(f"{path}: the module is empty; remove it, or name another file")
        text = f"{source.text[:place]}\n  {result.declaration}{source.text[place:]}"
        if not data:
            text = f"{source.text[:place]}{result.declaration}\n  {source.text[place:]}"
        write_source(path, text, source.encoding)
        return f"added {name} to {path}"
    line = source.place(old.start)[0]
    if old.type.key != type_:
        raise UserError(f"{path}:{line}: '{name}' is {old.type.text} there, not {type_}")
    if not replaces:
        raise UserError(f"{path}:{line}: '{name}' is declared; add --force to replace its value")
    value = result.declaration.partition(":=")[2]
    start = old.value.start if old.value is not None else old.end - 1
    between = "" if old.value is not None else ":="
    write_source(path, f"{source.text[:start]}{between}{value}{source.text[old.end :]}", source.encoding)
    return f"replaced {name} in {path}"


def poses_of_source(source: Source) -> list[tuple[str, str]]:
    """Return the robtargets and jointtargets that a module declares, in their order: types and values as text."""
    parsed = parse(source)
    data = [one for module in parsed.tree.modules for one in module.items if isinstance(one, tree.Data)]
    return [
        (one.type.key, one.value.text)
        for one in data
        if one.type.key in ("robtarget", "jointtarget") and isinstance(one.value, tree.Literals) and not one.dimensions
    ]


def _quaternion(rotation: Array) -> Array:
    x, y, z, w = Rotation.from_matrix(rotation).as_quat()
    return np.array([w, x, y, z]) * (1.0 if w >= 0.0 else -1.0)


def _list(values: Array, digits: int) -> str:
    return f"[{','.join(f'{round(float(one), digits) + 0.0:g}' for one in values)}]"
