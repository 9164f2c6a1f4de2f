"""Paths: arrays (n, 3) of poses (x, y, yaw), with common computations."""

import numpy as np

from daidalos.common.arrays import Array


def with_headings(points: Array, *, final_heading: float | None = None, initial_heading: float = 0.0) -> Array:
    """Return poses of points (n, 2), each facing the next one.

    Parameters
    ----------
    points : ndarray, shape (n, 2)
        Positions [m] in order.
    final_heading : float, optional
        Yaw [rad] of the last pose; the direction of arrival if not given.
    initial_heading : float
        Yaw [rad] of a path that goes nowhere.
    """
    path = np.empty((points.shape[0], 3))
    path[:, :2] = points
    path[:, 2] = initial_heading
    if points.shape[0] > 1:
        ahead = np.diff(points, axis=0)
        path[:-1, 2] = np.arctan2(ahead[:, 1], ahead[:, 0])
        path[-1, 2] = path[-2, 2]
    if final_heading is not None:
        path[-1, 2] = final_heading
    return path


def distances_along(path: Array) -> Array:
    """Return the distance [m] from the first pose to each pose along the path; shape (n,)."""
    steps = np.hypot(*np.diff(path[:, :2], axis=0).T)
    return np.concatenate([[0.0], np.cumsum(steps)])


def path_length(path: Array) -> float:
    """Return the length [m] of a path."""
    return float(np.hypot(*np.diff(path[:, :2], axis=0).T).sum())
