"""Turning an object with the mouse, as if it were in a ball of glass (Shoemake, 1992)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from ._quaternions import quaternion_from_matrix, quaternion_matrix, quaternion_multiply, quaternion_slerp
from ._vectors import EPSILON, Array, unit_vector


class Arcball:
    """A ball on the screen, and how it is turned.

    Parameters
    ----------
    initial
        How it is turned at first: a quaternion (x, y, z, w) or a homogeneous matrix.

    Raises
    ------
    ValueError
        When that is neither.
    """

    def __init__(self, initial: ArrayLike | None = None) -> None:
        self._center: Sequence[float] = (0.0, 0.0)
        self._radius = 1.0
        self._axes: list[Array] = []
        self._axis: Array | None = None
        self._constrain = False
        self._grip = np.array([0.0, 0.0, 1.0])
        self._before = self._previous = self._now = _orientation(initial)

    def place(self, center: Sequence[float], radius: float) -> None:
        """Put the ball on the screen, in pixels; y points downward."""
        self._center, self._radius = (float(center[0]), float(center[1])), float(radius)

    def setaxes(self, *axes: ArrayLike) -> None:
        """Set the axes that turning may be bound to."""
        self._axes = [unit_vector(axis) for axis in axes]

    def setconstrain(self, constrain: bool) -> None:
        """Bind turning to the nearest of the axes, or not."""
        self._constrain = bool(constrain)

    def getconstrain(self) -> bool:
        """Tell whether turning is bound to axes."""
        return self._constrain

    def down(self, point: Sequence[float]) -> None:
        """Grip the ball at a point of the screen."""
        self._grip = arcball_map_to_sphere(point, self._center, self._radius)
        self._before = self._previous = self._now
        self._axis = None
        if self._constrain and self._axes:
            self._axis = arcball_nearest_axis(self._grip, self._axes)
            self._grip = arcball_constrain_to_axis(self._grip, self._axis)

    def drag(self, point: Sequence[float]) -> None:
        """Turn the ball so that what was gripped comes to a point of the screen."""
        place = arcball_map_to_sphere(point, self._center, self._radius)
        if self._axis is not None:
            place = arcball_constrain_to_axis(place, self._axis)
        self._previous = self._now
        axis = np.cross(self._grip, place)
        if axis @ axis < EPSILON:
            self._now = self._before
        else:
            self._now = quaternion_multiply([*axis, self._grip @ place], self._before)

    def next(self, acceleration: float = 0.0) -> None:
        """Go on turning as in the last step."""
        following = quaternion_slerp(self._previous, self._now, 2.0 + acceleration)
        self._previous, self._now = self._now, following

    def matrix(self) -> Array:
        """Return the homogeneous matrix of how the ball is turned."""
        return quaternion_matrix(self._now)


def arcball_map_to_sphere(point: Sequence[float], center: Sequence[float], radius: float) -> Array:
    """Return the point of the unit sphere under a point of the screen, or the nearest one on its edge."""
    x, y = (point[0] - center[0]) / radius, (center[1] - point[1]) / radius
    squared = x * x + y * y
    if squared > 1.0:
        result: Array = unit_vector([x, y, 0.0])
        return result
    return np.array([x, y, np.sqrt(1.0 - squared)])


def arcball_constrain_to_axis(point: ArrayLike, axis: ArrayLike) -> Array:
    """Return the point of the sphere nearest to another that is perpendicular to an axis, on the side of the eye."""
    p, a = np.array(point, dtype=np.float64), np.array(axis, dtype=np.float64)
    p -= a * (a @ p)
    if p @ p <= EPSILON:  # the point is the axis's own: any will do
        p = np.array([1.0, 0.0, 0.0]) if a[2] == 1.0 else np.array([-a[1], a[0], 0.0])
    result: Array = unit_vector(-p if p[2] < 0.0 else p)
    return result


def arcball_nearest_axis(point: ArrayLike, axes: Sequence[ArrayLike]) -> Array:
    """Return the axis whose great circle comes nearest to a point of the sphere."""
    p = np.asarray(point, dtype=np.float64)
    nearest = max(axes, key=lambda axis: float(arcball_constrain_to_axis(p, axis) @ p))
    return np.asarray(nearest, dtype=np.float64)


def _orientation(initial: ArrayLike | None) -> Array:
    if initial is None:
        return np.array([0.0, 0.0, 0.0, 1.0])
    values = np.array(initial, dtype=np.float64)
    if values.shape == (4, 4):
        return quaternion_from_matrix(values)
    if values.shape == (4,):
        result: Array = unit_vector(values)
        return result
    raise ValueError("initial not a quaternion or matrix.")
