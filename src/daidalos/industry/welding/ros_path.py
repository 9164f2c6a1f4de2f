"""Paths of ROS: nav_msgs/msg/Path as `ros2 topic echo` prints it."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daidalos.common.documents import DocumentError, parse_yaml, read_text


def read_ros_path(path: Path) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the positions (n, 3) [m] and orientations (n, 3, 3) of the first message in a YAML file.

    Raises
    ------
    DocumentError
        Where it is no path; the message names the pose.
    """
    from scipy.spatial.transform import Rotation

    text = read_text(path)
    content = parse_yaml(text.split("\n---", maxsplit=1)[0], str(path))
    poses = content.get("poses") if isinstance(content, dict) else None
    if not isinstance(poses, list):
        raise DocumentError("has no list 'poses'; a nav_msgs/msg/Path is expected", str(path))
    positions = np.array([_vector(pose, "position", "xyz", n, str(path)) for n, pose in enumerate(poses)])
    quaternions = np.array([_vector(pose, "orientation", "xyzw", n, str(path)) for n, pose in enumerate(poses)])
    lengths = np.linalg.norm(quaternions.reshape(-1, 4), axis=1)
    if (np.abs(lengths - 1.0) > 1e-2).any():
        first = int(np.argmax(np.abs(lengths - 1.0) > 1e-2))
        raise DocumentError(f"poses[{first}].pose.orientation has the length {lengths[first]:.4g}, not 1", str(path))
    if not len(poses):
        return np.empty((0, 3)), np.empty((0, 3, 3))
    return positions, Rotation.from_quat(quaternions).as_matrix()


def _vector(entry: Any, name: str, axes: str, number: int, source: str) -> list[float]:
    part = entry
    for key in ("pose", name):
        part = part.get(key) if isinstance(part, dict) else None
    values = [part.get(axis) if isinstance(part, dict) else None for axis in axes]
    if not all(isinstance(one, int | float) and math.isfinite(one) for one in values):
        raise DocumentError(f"poses[{number}].pose.{name} must have finite {', '.join(axes)}", source)
    return [float(one) for one in values if one is not None]
