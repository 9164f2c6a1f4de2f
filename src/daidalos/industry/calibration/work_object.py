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


def work_object_deviations(
    x1: ArrayLike, x2: ArrayLike, y1: ArrayLike, touch_noise: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the covariances of origin (3, 3) [m^2] and rotation (3, 3) [rad^2], of touches with some noise.

    Parameters
    ----------
    x1, x2, y1
        As of `work_object_frame`.
    touch_noise
        Standard deviation of each coordinate of a touch [m].
    """
    points = np.concatenate([np.asarray(one, float) for one in (x1, x2, y1)])
    frame = work_object_frame(x1, x2, y1)
    origin, rotation = np.empty((3, 9)), np.empty((3, 9))
    for i in range(9):
        moved = points.copy()
        moved[i] += _DIFFERENCE
        other = work_object_frame(*moved.reshape(3, 3))
        origin[:, i] = (other[:3, 3] - frame[:3, 3]) / _DIFFERENCE
        turned = other[:3, :3] @ frame[:3, :3].T
        rotation[:, i] = np.array([turned[2, 1], turned[0, 2], turned[1, 0]]) / _DIFFERENCE
    variance = touch_noise**2
    return variance * origin @ origin.T, variance * rotation @ rotation.T


def work_object_warnings(x1: ArrayLike, x2: ArrayLike, y1: ArrayLike) -> list[str]:
    """Return what makes a frame doubtful: points that are close, or nearly on one line."""
    first, second, third = (np.asarray(point, float) for point in (x1, x2, y1))
    along, towards = second - first, third - first
    found = []
    if (shortest := min(np.linalg.norm(along), np.linalg.norm(towards))) < SHORT_SIDE:
        found.append(
            f"bad geometry: two points are {1e3 * shortest:.0f} mm apart; take at least {1e3 * SHORT_SIDE:.0f}"
        )
    sine = np.linalg.norm(np.cross(along, towards)) / (np.linalg.norm(along) * np.linalg.norm(towards))
    if sine < SMALL_SINE:
        found.append(f"bad geometry: y1 is {np.degrees(np.arcsin(sine)):.0f} deg from the x axis; take it farther away")
    return found


_DIFFERENCE = 1e-7
SHORT_SIDE = 0.05
"""Distance of two points below which the geometry is bad [m]."""

SMALL_SINE = 0.26
"""Sine of the angle at x1 below which the geometry is bad: that of 15 degrees."""
