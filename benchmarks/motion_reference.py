"""A fine numerical reference of blended motion, which shares no code with the planner but the arm's kinematics.

The path is computed from the definition of lines and parabolas, its derivatives by differences, the speeds by a linear
programme for `scipy.optimize.linprog`, the moving average by a sum over samples, and the limits that it exceeds are
lowered in small steps.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linprog
from scipy.sparse import coo_matrix, vstack

from daidalos.industry.motion.kinematics import inverse
from daidalos.industry.robots import Arm

Array = NDArray[np.float64]
STEP = 0.75e-3
PERIOD = 0.25e-3
EASE, ROUNDS = 0.35, 40
TOLERANCE = 1.01


@dataclass(frozen=True)
class Reference:
    """Reference of a motion.

    Attributes
    ----------
    time : float
        Duration [s].
    path : array of shape (n, 3)
        Points of the path [m].
    """

    time: float
    path: Array


def polyline_with_parabolas(corners: list[Array], zone: float, step: float) -> Array:
    """Return points, a step apart, of lines whose corners are parabolas from a distance on, half of a line at most."""
    pieces, start = [], corners[0]
    for before, corner, after in zip(corners, corners[1:], corners[2:], strict=False):
        reach = min(zone, *(0.5 * float(np.linalg.norm(one - corner)) for one in (before, after)))
        a, b = (corner + reach * (one - corner) / np.linalg.norm(one - corner) for one in (before, after))
        u = np.linspace(0.0, 1.0, 2001)[:, None]
        pieces += [_line(start, a), (1 - u) ** 2 * a + 2 * u * (1 - u) * corner + u**2 * b]
        start = b
    return _resampled(np.concatenate([*pieces, _line(start, corners[-1])]), step)


def _line(start: Array, end: Array) -> Array:
    return np.asarray(start + np.linspace(0.0, 1.0, 3000)[:, None] * (end - start))


def _resampled(points: Array, step: float) -> Array:
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    keep = np.concatenate([[True], np.diff(way) > 0.0])
    even = np.linspace(0.0, way[-1], int(way[-1] / step) + 1)
    return np.stack([np.interp(even, way[keep], points[keep, k]) for k in range(3)], axis=1)


def solve(arm: Arm, path: Array, rotation: Array, start: Array, speed: float) -> Reference:
    """Return the reference of a motion along points of a path [m], with one orientation (3, 3), from angles (6,)."""
    poses = np.tile(np.eye(4), (len(path), 1, 1))
    poses[:, :3, :3], poses[:, :3, 3] = rotation, path
    solutions = inverse(arm, poses).joints
    branch = int(np.nanargmin(np.abs(solutions[0] - start).max(axis=1)))
    q = np.unwrap(solutions[:, branch], axis=0)
    s = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    first = np.gradient(q, s, axis=0, edge_order=2)
    second = np.gradient(first, s, axis=0, edge_order=2)
    caps = np.minimum(speed**2, ((arm.speeds / np.maximum(np.abs(first), 1e-9)) ** 2).min(axis=1))
    limits = np.tile(arm.accelerations, (len(s), 1))
    time = np.inf
    for _ in range(ROUNDS):
        x = _programme(s, first, second, limits, caps)
        time, ratios, raw = _after_mean(arm, s, x, first, second, speed)
        bad = ratios > TOLERANCE
        if not bad.any():
            break
        factors = np.ones(len(s))
        width = round(arm.ramp_time / PERIOD)
        for n in np.flatnonzero(bad)[::4]:
            a, b = np.searchsorted(s, raw[max(n - width, 0)]) - 1, np.searchsorted(s, raw[min(n, len(raw) - 1)]) + 1
            np.minimum(factors[max(a, 0) : b], ratios[n] ** -EASE, out=factors[max(a, 0) : b])
        caps, limits = caps * factors, limits * factors[:, None]
    return Reference(time, path)


def _programme(s: Array, first: Array, second: Array, limits: Array, caps: Array) -> Array:
    """Return the greatest x = s'^2 at all points: that of the greatest sum."""
    n, rows = len(s), 6
    step = np.diff(s)
    i = np.repeat(np.arange(n - 1), rows)
    row = np.arange(len(i))
    slope = (first[:-1] / (2.0 * step[:, None])).ravel()
    bend = second[:-1].ravel()
    matrix: Any = coo_matrix(
        (np.concatenate([bend - slope, slope]), (np.concatenate([row, row]), np.concatenate([i, i + 1]))),
        shape=(len(i), n),
    )
    bound = limits[:-1].ravel()
    bounds = np.stack([np.zeros(n), caps], axis=1)
    bounds[[0, -1], 1] = 0.0
    solution = linprog(-np.ones(n), vstack([matrix, -matrix]), np.concatenate([bound, bound]), bounds=bounds)
    assert solution.status == 0, solution.message
    return np.asarray(np.maximum(solution.x, 0.0))


def _after_mean(arm: Arm, s: Array, x: Array, first: Array, second: Array, speed: float) -> tuple[float, Array, Array]:
    """Return the duration, by how much limits are exceeded at samples of the mean, and the samples before the mean."""
    v = np.sqrt(x)
    times = np.concatenate([[0.0], np.cumsum(2.0 * np.diff(s) / np.maximum(v[1:] + v[:-1], 1e-9))])
    width = round(arm.ramp_time / PERIOD)
    t = np.arange(0.0, times[-1] + arm.ramp_time + PERIOD, PERIOD)
    index = np.clip(np.searchsorted(times, t, side="right") - 1, 0, len(s) - 2)
    dt = np.minimum(t - times[index], np.diff(times)[index])
    raw = np.minimum(s[index] + v[index] * dt + np.diff(x)[index] / (4.0 * np.diff(s)[index]) * dt**2, s[-1])
    padded = np.concatenate([np.zeros(width), raw])
    total = np.concatenate([[0.0], np.cumsum(padded)])
    mean = (total[width + 1 :] - total[1:-width]) / width
    velocity = np.gradient(mean, PERIOD)
    acceleration = np.gradient(velocity, PERIOD)
    slopes = np.stack([np.interp(mean, s, first[:, k]) for k in range(6)], axis=1)
    bends = np.stack([np.interp(mean, s, second[:, k]) for k in range(6)], axis=1)
    forces = np.abs(slopes * acceleration[:, None] + bends * (velocity**2)[:, None]) / arm.accelerations
    rates = np.abs(slopes * velocity[:, None]) / arm.speeds
    ratios = np.maximum(forces.max(axis=1), np.maximum(rates.max(axis=1), velocity / speed) ** 2)
    return float(times[-1] + arm.ramp_time), ratios, raw
