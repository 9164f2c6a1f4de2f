"""Calibration of a workpiece's frame from three touched points."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daidalos.industry.calibration.tool import CalibrationError

_MIN_SINE = 1e-3


def work_object_frame(x1: ArrayLike, x2: ArrayLike, y1: ArrayLike) -> NDArray[np.float64]:
    """Return the frame of a work object, base from object, by the three-point method of robot manuals.

    Parameters
    ----------
    x1, x2 : (3,) array
        Two points on the object's x axis [m], x1 before x2.
    y1 : (3,) array
        A point on its y axis [m]. The origin is its foot on the x axis.

    Returns
    -------
    (4, 4) array
        The transform.

    Raises
    ------
    CalibrationError
        Where the points coincide or lie on one line.
    """
    first, second, third = (np.asarray(point, float) for point in (x1, x2, y1))
    along, towards = second - first, third - first
    lengths = np.linalg.norm(along) * np.linalg.norm(towards)
    normal = np.cross(along, towards)
    if np.linalg.norm(normal) <= _MIN_SINE * lengths:
        raise CalibrationError("the three points coincide or lie on one line: touch y1 farther from the x axis")
    x = along / np.linalg.norm(along)
    z = normal / np.linalg.norm(normal)
    frame = np.eye(4)
    frame[:3, :3] = np.column_stack([x, np.cross(z, x), z])
    frame[:3, 3] = first + x * (towards @ x)
    return frame
