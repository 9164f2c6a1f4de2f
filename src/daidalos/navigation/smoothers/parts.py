"""Smoothing of a path part by part, so that places where the robot reverses stay where they are."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from daidalos.common.arrays import Array
from daidalos.navigation.paths import is_driven_backwards, split_at_cusps, with_headings


def smooth_parts(path: Array, smooth: Callable[[Array], Array], *, split: bool, times: int = 1) -> Array:
    """Smooth a path (n, 3) and return it with the same ends.

    Parameters
    ----------
    path : ndarray, shape (n, 3)
        Poses (x, y, yaw).
    smooth : callable
        Returns smoothed points (m, 2) of points (m, 2), with the same first and last one.
    split : bool
        Whether the parts between cusps are smoothed each on its own.
    times : int
        How often each part is smoothed; every time after the first refines the result of the one before.

    Returns
    -------
    ndarray, shape (n, 3)
        Poses that look along the path, backwards where the robot drives backwards.
    """
    if path.shape[0] < 3:
        return path.copy()
    parts = split_at_cusps(path) if split else [path]
    return np.concatenate([_part(part, smooth, times)[int(i > 0) :] for i, part in enumerate(parts)])


def _part(part: Array, smooth: Callable[[Array], Array], times: int) -> Array:
    if part.shape[0] < 3:
        return part
    points = np.ascontiguousarray(part[:, :2])
    for _ in range(times):
        points = smooth(points)
    smoothed = with_headings(points)
    if is_driven_backwards(part):
        smoothed[:, 2] = np.remainder(smoothed[:, 2] + 2.0 * np.pi, 2.0 * np.pi) - np.pi
    smoothed[-1, 2] = part[-1, 2]
    return smoothed
