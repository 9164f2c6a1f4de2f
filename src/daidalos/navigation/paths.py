"""Paths: arrays (n, 3) of poses (x, y, yaw), with common computations."""

from itertools import pairwise

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


def split_at_cusps(path: Array) -> list[Array]:
    """Return the parts of a path (n, 3) between the poses at which the robot reverses its direction of motion.

    Neighbouring parts share the pose at the cusp. A path that repeats a position, to turn in place, is split there too.
    """
    steps = np.diff(path[:, :2], axis=0)
    cusps = np.flatnonzero(np.sum(steps[:-1] * steps[1:], axis=1) < 0.0) + 1
    turns = np.flatnonzero(~steps.any(axis=1))
    borders = sorted({0, *cusps.tolist(), *turns.tolist(), *(turns + 1).tolist(), path.shape[0] - 1})
    return [path[begin : end + 1] for begin, end in pairwise(borders)]


def is_driven_backwards(part: Array) -> bool:
    """Return whether a part of a path without cusps looks against its direction of motion."""
    step = part[1, :2] - part[0, :2]
    return float(step[0] * np.cos(part[0, 2]) + step[1] * np.sin(part[0, 2])) < 0.0
