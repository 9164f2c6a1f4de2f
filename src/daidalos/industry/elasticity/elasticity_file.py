"""Files of elasticity: YAML with a value, a unit, an uncertainty and a source for each quantity."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daidalos.common.documents import DocumentError, read_yaml
from daidalos.common.suggestions import hint
from daidalos.industry.elasticity.elasticity import PER_AXIS, Elasticity

_ANGLES = {"rad": 1.0, "deg": math.pi / 180.0, "arcmin": math.pi / 10800.0}
_UNITS: dict[str, dict[str, float]] = {
    "stiffness": {"Nm/rad": 1.0, "kNm/rad": 1e3},
    "backlash": _ANGLES,
    "damping": {"Nm s/rad": 1.0},
    "coulomb_friction": {"Nm": 1.0},
    "breakaway_friction": {"Nm": 1.0},
    "stribeck_speed": {f"{name}/s": factor for name, factor in _ANGLES.items()},
    "viscous_friction": {"Nm s/rad": 1.0},
    "mass": {"kg": 1.0},
    "centre_of_mass": {"m": 1.0, "mm": 1e-3},
    "balancing": {"Nm": 1.0},
}
_KEYS = ("unit", "value", "uncertainty", "source")
_POSITIVE = ("stiffness", "stribeck_speed")


def read_elasticity(path: Path, robot: str) -> Elasticity:
    """Return the elasticity in a file.

    Parameters
    ----------
    path : Path
        The file.
    robot : str
        Name of the arm that it must be for.

    Raises
    ------
    DocumentError
        When it is none, or is for another arm.
    OSError
        When it cannot be opened.
    """
    content = read_yaml(path)
    if not isinstance(content, dict):
        raise DocumentError("must be a mapping of quantities such as 'stiffness'", str(path))
    for key in content:
        if key != "robot" and key not in _UNITS:
            raise DocumentError(f"there is no quantity '{key}'{hint(str(key), _UNITS)}", str(path))
    if content.get("robot") != robot:
        raise DocumentError(f"is for the robot '{content.get('robot')}', not for '{robot}'", str(path))
    values: dict[str, NDArray[np.float64]] = {}
    deviations: dict[str, NDArray[np.float64]] = {}
    for name in _UNITS:
        if name not in content:
            raise DocumentError(f"has no '{name}'; a mapping with {', '.join(_KEYS)} is expected", str(path))
        values[name], deviations[name] = _quantity(content[name], name, str(path))
    return Elasticity(**values, uncertainty=deviations)


def write_elasticity(path: Path, robot: str, found: Elasticity, sources: dict[str, str]) -> None:
    """Write an elasticity as YAML in SI units; `sources` names the origin of each quantity.

    Raises
    ------
    FileExistsError
        Where there is such a file.
    """
    lines = ["# Written by daidalos weld identify. `uncertainty` is one standard deviation.", f"robot: {robot}"]
    for name in _UNITS:
        unit = next(text for text, factor in _UNITS[name].items() if factor == 1.0)
        lines += [f"{name}:", f"  unit: {unit}", f"  value: {_text(getattr(found, name))}"]
        lines += [f"  uncertainty: {_text(found.uncertainty[name])}", f"  source: {sources[name]}"]
    with open(path, "x", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")


def _text(values: NDArray[np.float64]) -> str:
    if values.ndim > 1:
        return f"[{', '.join(map(_text, values))}]"
    return f"[{', '.join(repr(float(f'{value:.6g}')) for value in values)}]"


def _quantity(entry: Any, name: str, source: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return values and standard deviations in SI units."""
    if not isinstance(entry, dict) or set(entry) != set(_KEYS):
        raise DocumentError(f"'{name}' must be a mapping with {', '.join(_KEYS)}", source)
    factor = _UNITS[name].get(str(entry["unit"]))
    if factor is None:
        raise DocumentError(f"'{name}' is in '{entry['unit']}', but must be in {' or '.join(_UNITS[name])}", source)
    shape = (6,) if name in PER_AXIS else (6, 3)
    values = _numbers(entry["value"], shape, f"{name}.value", source)
    deviations = _numbers(entry["uncertainty"], (6,), f"{name}.uncertainty", source)
    negative = (values <= 0.0) if name in _POSITIVE else (values < 0.0)
    if name in PER_AXIS and name != "balancing" and negative.any():
        least = "greater than 0" if name in _POSITIVE else "0 or greater"
        raise DocumentError(f"'{name}' of axis {int(negative.argmax()) + 1} must be {least}", source)
    if (deviations < 0.0).any():
        raise DocumentError(f"'{name}.uncertainty' must not be negative", source)
    return factor * values, factor * deviations


def _numbers(value: Any, shape: tuple[int, ...], name: str, source: str) -> NDArray[np.float64]:
    try:
        array = np.array(value, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        array = np.array(math.nan)
    if array.shape != shape or not np.isfinite(array).all():
        wanted = "six finite numbers" if len(shape) == 1 else "six lists of three finite numbers"
        raise DocumentError(f"'{name}' must be {wanted}, one per axis", source)
    return array
