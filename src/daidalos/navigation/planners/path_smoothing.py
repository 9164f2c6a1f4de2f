"""Smoothing of paths that robots with a turning radius can drive: within the curvature and free of obstacles."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.navigation.costmap.costmap import Costs
from daidalos.navigation.paths import is_driven_backwards, split_at_cusps
from daidalos.navigation.planners.curves import remainder
from daidalos.navigation.planners.goal_curves import CORNER, SPACING, crosses_free, drives_free, stands_free
from daidalos.navigation.planners.search import Prices
from daidalos.navigation.planners.smac_parameters import PathSmoothing
from daidalos.navigation.smoothers.parts import smooth_parts
from daidalos.navigation.smoothers.simple_smoother import relax


def smoothed(
    path: Array, costs: Costs, price: Prices, polygon: Array, radius: float, options: PathSmoothing, resolution: float
) -> Array:
    """Smooth a path within the turning radius; its ends stay, with their headings.

    Parameters
    ----------
    path : ndarray, shape (n, 3)
        Poses, positions in cells.
    costs, price, polygon
        See `stands_free`.
    radius : float
        Turning radius in cells.
    options : PathSmoothing
    resolution : float
        Of the cells [m].
    """
    window = max(round(2.0 * radius / SPACING), 2)
    limit = (1.0 + 1e-6) / radius

    def forbidden(points: Array) -> Any:
        return are_forbidden(points, costs, price, polygon, is_backwards, limit)

    def smooth(points: Array) -> Array:
        relaxed = relax(
            points, costs, 1.0, CORNER, options.w_data, options.w_smooth, options.tolerance / resolution**2,
            options.max_iterations,
        )  # fmt: skip
        return blended(points, relaxed, window, forbidden)

    parts = [path[:1]]
    for part in split_at_cusps(path):
        is_backwards = part.shape[0] > 1 and is_driven_backwards(part)
        found = smooth_parts(part, smooth, split=False, times=options.times)
        is_unmoved = (found[:, :2] == part[:, :2]).all(axis=1)  # which is free at its own heading, not at any
        found[is_unmoved, 2] = part[is_unmoved, 2]
        parts.append(found[1:])
    return np.concatenate(parts)


def smoothed_at_headings(
    path: Array, costs: Costs, price: Prices, polygon: Array, radius: float, options: PathSmoothing, resolution: float
) -> Array:
    """Smooth the positions of a path of a robot that can go to every side; see `smoothed`. Headings stay."""
    window = max(round(2.0 * radius / SPACING), 2)

    def forbidden(points: Array) -> Any:
        return _touches(points, headings, costs, price, polygon)

    parts = [path[:1]]
    for part in split_at_cusps(path):
        points, headings = np.ascontiguousarray(part[:, :2]), np.ascontiguousarray(part[:, 2])
        for _ in range(options.times if part.shape[0] > 2 else 0):
            relaxed = relax(
                points, costs, 1.0, CORNER, options.w_data, options.w_smooth, options.tolerance / resolution**2,
                options.max_iterations,
            )  # fmt: skip
            points = blended(points, relaxed, window, forbidden)
        parts.append(np.column_stack([points, headings])[1:])
    return np.concatenate(parts)


def blended(given: Array, smooth: Array, window: int, forbidden: Callable[[Array], NDArray[np.bool_]]) -> Array:
    """Return points as near to smoothed ones as is allowed, and the given ones at both ends.

    Parameters
    ----------
    given, smooth : ndarray, shape (n, 2)
        The given points are allowed.
    window : int
        Number of points on each side over which the share of the smoothed ones goes down to that at a forbidden point.
    forbidden : callable
        Returns which points of a path are not allowed.
    """
    index = np.arange(given.shape[0])
    share = np.clip((np.minimum(index, index[::-1]) - 1.0) / window, 0.0, 1.0)
    share *= share * (3.0 - 2.0 * share)
    fade = 1.0 - 0.5 * (1.0 + np.cos(np.pi * np.arange(-window, window + 1) / window))
    for _ in range(20):
        points = given + share[:, None] * (smooth - given)
        wrong = forbidden(points)
        if not wrong.any():
            return points
        factor = np.ones_like(share)
        for at in np.flatnonzero(wrong).tolist():
            low, high = max(at - window, 0), min(at + window + 1, share.size)
            part = fade[low - at + window : high - at + window]
            factor[low:high] = np.minimum(factor[low:high], part)
        share *= factor
    return given


@compiled
def are_forbidden(
    points: Array, costs: Costs, price: Prices, polygon: Array, is_backwards: bool, curvature: float
) -> NDArray[np.bool_]:
    """Return which points (n, 2) of a part of a path without cusps are bent too much, or the robot is in contact at."""
    count = points.shape[0]
    wrong = np.zeros(count, dtype=np.bool_)
    for i in range(1, count - 1):
        wrong[i] = _curvature(points, i) > curvature
    for i in range(count - 1):
        dx, dy = points[i + 1, 0] - points[i, 0], points[i + 1, 1] - points[i, 1]
        yaw = math.atan2(-dy, -dx) if is_backwards else math.atan2(dy, dx)
        for k in range(5):
            x, y = points[i, 0] + 0.25 * k * dx, points[i, 1] + 0.25 * k * dy
            is_passed = k == 0 or crosses_free(costs, price, x - 0.25 * dx, y - 0.25 * dy, x, y)
            if not is_passed or not stands_free(costs, price, polygon, x, y, yaw):
                wrong[i] = wrong[i + 1] = True
                break
    return wrong


@compiled
def _touches(points: Array, headings: Array, costs: Costs, price: Prices, polygon: Array) -> NDArray[np.bool_]:
    """Return at which points (n, 2) the robot, at given headings, is in contact, or on the way to the next one."""
    wrong = np.zeros(points.shape[0], dtype=np.bool_)
    for i in range(points.shape[0] - 1):
        x, y, yaw = points[i, 0], points[i, 1], headings[i]
        for k in range(1, 5):
            to_x = points[i, 0] + 0.25 * k * (points[i + 1, 0] - points[i, 0])
            to_y = points[i, 1] + 0.25 * k * (points[i + 1, 1] - points[i, 1])
            to_yaw = headings[i] + 0.25 * k * remainder(headings[i + 1] - headings[i])
            if not drives_free(costs, price, polygon, x, y, yaw, to_x, to_y, to_yaw):
                wrong[i] = wrong[i + 1] = True
                break
            x, y, yaw = to_x, to_y, to_yaw
    return wrong


@compiled
def _curvature(points: Array, i: int) -> float:
    """Return the curvature of the circle through a point and its two neighbours; infinite where they turn back."""
    ax, ay = points[i, 0] - points[i - 1, 0], points[i, 1] - points[i - 1, 1]
    bx, by = points[i + 1, 0] - points[i, 0], points[i + 1, 1] - points[i, 1]
    if ax * bx + ay * by <= 0.0:
        return np.inf
    return float(
        2.0 * abs(ax * by - ay * bx) / (math.hypot(ax, ay) * math.hypot(bx, by) * math.hypot(ax + bx, ay + by))
    )
