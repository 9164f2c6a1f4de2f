"""Point of a path at a distance from the robot."""

import math

import numpy as np

from daidalos.common.arrays import Array


def look_ahead_point(points: Array, distance: float) -> tuple[Array, int]:
    """Return where a path first leaves a circle around the origin, and the index of the next point of the path.

    Parameters
    ----------
    points : ndarray, shape (n, 2)
        Path [m] in the robot's frame. Its first point is returned where that is outside of the circle, its last one
        where it stays inside.
    distance : float
        Radius of the circle [m].
    """
    beyond = np.flatnonzero(np.hypot(points[:, 0], points[:, 1]) >= distance)
    if beyond.size == 0:
        return np.array(points[-1]), points.shape[0] - 1
    outer = int(beyond[0])
    if outer == 0:
        return np.array(points[0]), 0
    return _on_circle(points[outer - 1], points[outer], distance), outer


def _on_circle(inner: Array, outer: Array, radius: float) -> Array:
    """Return the intersection of a circle around the origin with the line from a point inside to one outside."""
    step = outer - inner
    a = float(step @ step)
    b = float(inner @ step)
    c = float(inner @ inner) - radius * radius
    share = (-b + math.sqrt(max(b * b - a * c, 0.0))) / a if a > 0.0 else 1.0
    return np.array(inner + min(max(share, 0.0), 1.0) * step)
