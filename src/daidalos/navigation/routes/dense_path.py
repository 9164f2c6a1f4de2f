"""Dense paths along routes, with arcs at corners."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.paths import with_headings
from daidalos.navigation.routes.graph import Route


@dataclass(frozen=True)
class DensePathParameters(Parameters):
    """Parameters, by their Nav2 names."""

    path_density: float = parameter(0.05, "Distance of the poses of a path.", unit="m", above=0.0)
    smooth_corners: bool = parameter(False, "Whether corners are arcs.")
    smoothing_radius: float = parameter(1.0, "Radius of these arcs.", unit="m", above=0.0)


def dense_path(
    route: Route, p: DensePathParameters, begin: Array | None = None, warn: Callable[[str], None] = lambda line: None
) -> Array:
    """Return poses (n, 3) along a route.

    Parameters
    ----------
    route : Route
    p : DensePathParameters
    begin : ndarray, shape (2,), optional
        Point [m] before the first node at which the path begins.
    warn : callable
        Called with a line for each corner that is too short or too sharp for its arc.
    """
    corners = [node.point for node in route.nodes]
    if begin is not None:
        corners.insert(0, begin)
    if len(corners) == 1:
        return np.array([[*corners[0], 0.0]])
    points: list[Array] = []
    start = corners[0]
    for corner, following in pairwise(corners[1:]):
        arc = _arc(start, corner, following, p) if p.smooth_corners else None
        if arc is None:
            if p.smooth_corners and not _is_straight(start, corner, following):
                warn(f"the corner at ({corner[0]:.2f}, {corner[1]:.2f}) has no room for an arc of radius "
                     f"{p.smoothing_radius:g} m")  # fmt: skip
            arc = corner[None]
        points += [_line(start, arc[0], p.path_density), arc[:-1]]
        start = arc[-1]
    points += [_line(start, corners[-1], p.path_density), corners[-1][None]]
    return with_headings(np.concatenate(points))


def _line(start: Array, end: Array, density: float) -> Array:
    """Return points on a line without its end, shape (n, 2)."""
    count = math.ceil(float(np.hypot(*(end - start))) / density)
    shares = np.arange(count)[:, None] / max(count, 1)
    points: Array = start + shares * (end - start)
    return points


def _is_straight(start: Array, corner: Array, end: Array) -> bool:
    into, out = corner - start, end - corner
    return abs(float(into[0] * out[1] - into[1] * out[0])) < 1e-6 and float(into @ out) >= 0.0


def _arc(start: Array, corner: Array, end: Array, p: DensePathParameters) -> Array | None:
    """Return points of the arc that touches both edges at a corner, None where the edges are too short for it."""
    back, ahead = start - corner, end - corner
    lengths = float(np.hypot(*back)), float(np.hypot(*ahead))
    if min(lengths) < 1e-9:
        return None
    back, ahead = back / lengths[0], ahead / lengths[1]
    angle = math.acos(min(max(float(back @ ahead), -1.0), 1.0))
    if angle < 1e-6 or math.pi - angle < 1e-6:
        return None
    tangent = p.smoothing_radius / math.tan(0.5 * angle)
    if tangent >= min(lengths):
        return None
    bisector = (back + ahead) / float(np.hypot(*(back + ahead)))
    center = corner + bisector * (p.smoothing_radius / math.sin(0.5 * angle))
    first = corner + tangent * back - center
    turn = math.copysign(math.pi - angle, float(ahead[1] * back[0] - ahead[0] * back[1]) * -1.0)
    steps = max(1, math.ceil(abs(turn) * p.smoothing_radius / p.path_density))
    angles = np.linspace(0.0, turn, steps + 1)
    cosine, sine = np.cos(angles), np.sin(angles)
    points: Array = center + np.stack([first[0] * cosine - first[1] * sine, first[0] * sine + first[1] * cosine], 1)
    return points
