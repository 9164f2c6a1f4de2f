"""Files of calibrations: the result with its covariance, and the session that can be resumed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from daidalos.common.documents import DocumentError, read_yaml
from daidalos.common.pose3 import Pose, Vector
from daidalos.common.suggestions import hint
from daidalos.industry.lighting.calibration import PARAMETERS, Calibration, Observation
from daidalos.industry.lighting.kinematics import Angles, Geometry

_RESULT_KEYS = (
    "head", "position", "orientation", "tilt_zero", "axis_skew", "beam_skew", "residual", "noise", "condition",
    "worst_expected_error", "parameters", "covariance", "observations",
)  # fmt: skip


def write_calibration(
    path: Path, head: str, found: Calibration, observations: Sequence[Observation], worst_error: float
) -> None:
    """Write a calibration as YAML, whole or not at all."""
    geometry = found.geometry
    content = {
        "head": head,
        "position": list(geometry.pose.position),
        "orientation": list(geometry.pose.orientation),
        "tilt_zero": geometry.tilt_zero,
        "axis_skew": geometry.axis_skew,
        "beam_skew": geometry.beam_skew,
        "residual": found.residual,
        "noise": found.noise,
        "condition": found.condition,
        "worst_expected_error": worst_error,
        "parameters": list(PARAMETERS),
        "covariance": found.covariance.tolist(),
        "observations": [_as_entry(one) for one in observations],
    }
    heading = "# Written by daidalos light calibrate: metres, radians, orientation as x, y, z, w.\n"
    _write(path, heading, content)


def read_geometry(path: Path) -> Geometry:
    """Return the pose and the angles of a calibration file.

    Raises
    ------
    DocumentError
        When it is none.
    OSError
        When it cannot be opened.
    """
    content = _mapping(path, _RESULT_KEYS)
    x, y, z = _numbers(content, "position", 3, path)
    qx, qy, qz, qw = _numbers(content, "orientation", 4, path)
    length = math.sqrt(qx * qx + qy * qy + qz * qz + qw * qw)
    if abs(length - 1.0) > 1e-3:
        raise DocumentError("'orientation' must be a quaternion of length 1", str(path))
    angles = [_numbers({key: [content.get(key)]}, key, 1, path)[0] for key in ("tilt_zero", "axis_skew", "beam_skew")]
    return Geometry(Pose((x, y, z), (qx / length, qy / length, qz / length, qw / length)), *angles)


def write_session(path: Path, head: str, observations: Sequence[Observation]) -> None:
    """Write what has been confirmed so far, whole or not at all."""
    content = {"head": head, "observations": [_as_entry(one) for one in observations]}
    _write(path, "# Session of daidalos light calibrate; the same command resumes it.\n", content)


def read_session(path: Path, head: str) -> list[Observation]:
    """Return the observations of a session.

    Raises
    ------
    DocumentError
        When the file is no session of this head.
    OSError
        When it cannot be opened.
    """
    content = _mapping(path, ("head", "observations"))
    if content.get("head") != head:
        raise DocumentError(f"is a session of the head '{content.get('head')}', not of '{head}'", str(path))
    items = content.get("observations")
    if not isinstance(items, list) or not all(isinstance(one, dict) for one in items):
        raise DocumentError("'observations' must be a list of mappings", str(path))
    found = []
    for item in items:
        x, y, z = _numbers(item, "point", 3, path)
        pan, tilt = _numbers(item, "angles", 2, path)
        found.append(Observation((x, y, z), Angles(pan, tilt)))
    return found


def read_points(path: Path) -> list[Vector]:
    """Return the points [m] of a YAML file: a list of ``[x, y, z]``.

    Raises
    ------
    DocumentError
        When it is none.
    OSError
        When it cannot be opened.
    """
    content = read_yaml(path)
    if not isinstance(content, list) or not content:
        raise DocumentError("must be a list of points [x, y, z]", str(path))
    found: list[Vector] = []
    for index, item in enumerate(content):
        x, y, z = _numbers({f"point {index + 1}": item}, f"point {index + 1}", 3, path)
        found.append((x, y, z))
    return found


def _as_entry(observation: Observation) -> dict[str, list[float]]:
    return {
        "point": [float(one) for one in observation.point],
        "angles": [float(observation.angles.pan), float(observation.angles.tilt)],
    }


def _write(path: Path, heading: str, content: dict[str, Any]) -> None:
    import yaml

    part = path.with_name(f"{path.name}.part")
    part.write_text(heading + yaml.safe_dump(content, sort_keys=False, default_flow_style=None), encoding="utf-8")
    part.replace(path)


def _mapping(path: Path, keys: tuple[str, ...]) -> dict[str, Any]:
    content = read_yaml(path)
    if not isinstance(content, dict):
        raise DocumentError(f"must be a mapping with {', '.join(keys)}", str(path))
    for key in content:
        if key not in keys:
            raise DocumentError(f"'{key}' is unknown{hint(str(key), keys)}", str(path))
    return content


def _numbers(content: dict[str, Any], key: str, count: int, path: Path) -> list[float]:
    value = content.get(key)
    if isinstance(value, list) and len(value) == count and all(type(one) in (int, float) for one in value):
        found = [float(one) for one in value]
        if all(math.isfinite(one) for one in found):
            return found
    what = "a finite number" if count == 1 else f"a list of {count} finite numbers"
    raise DocumentError(f"'{key}' must be {what}", str(path))
