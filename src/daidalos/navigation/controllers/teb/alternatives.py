"""Ways around obstacles that are distinct: each passes some obstacle on another side.

Obstacles are the connected groups of cells that the robot cannot pass between. The ways are paths in a graph of points
beside them, as in the exploration of homotopy classes of Rösmann et al. (Robotics and Autonomous Systems 88, 2017); the
class of a way is the number of times that it winds around each obstacle.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.common.pose2 import wrap
from daidalos.localization.likelihood_map import Table

Signature = tuple[int, ...]

_MOST_OBSTACLES = 8
"""Number of obstacles that are told apart, the nearest to the line from the start to the goal."""

_MOST_PATHS = 200
"""Number of paths of the graph that are looked at."""


@dataclass(frozen=True)
class Obstacles:
    """Obstacles beside the way.

    Attributes
    ----------
    centers : ndarray, shape (k, 2)
        Their middles [m].
    sides : ndarray, shape (k, 2, 2)
        For each, a point [m] to the right and one to the left of it, as seen from the start.
    """

    centers: Array
    sides: Array


def obstacles_beside(
    distance: Table, origin: Array, resolution: float, start: Array, goal: Array, *, width: float, away: float
) -> Obstacles:
    """Return the obstacles in a corridor between two positions.

    Parameters
    ----------
    distance : ndarray of float32, shape (height, width)
        Distance [m] of each cell to the nearest obstacle.
    origin : ndarray, shape (2,)
        Outer corner of cell (0, 0) [m].
    resolution : float
        Side of a cell [m].
    start, goal : ndarray, shape (2,)
        [m].
    width : float
        Of the corridor [m].
    away : float
        Distance [m] from obstacles at which the robot passes them.
    """
    from scipy.ndimage import label

    along = goal - start
    length = math.hypot(*along)
    if length < 1e-6:
        return Obstacles(np.zeros((0, 2)), np.zeros((0, 2, 2)))
    ahead, left = along / length, np.array([-along[1], along[0]]) / length
    groups, count = label(distance < away, structure=np.ones((3, 3)))
    found = []
    for number in range(1, count + 1):
        rows, columns = np.nonzero(groups == number)
        points = origin + resolution * (np.stack([columns, rows], axis=-1) + 0.5) - start
        forward, sideways = points @ ahead, points @ left
        inside = (forward > 0.0) & (forward < length) & (np.abs(sideways) < 0.5 * width)
        if not inside.any() or float(np.hypot(*points.T).min()) < resolution:
            continue
        offset = np.abs(sideways[inside]).min()
        low, high = int(sideways.argmin()), int(sideways.argmax())
        beside = np.array([points[low] - resolution * left, points[high] + resolution * left])
        found.append((float(offset), points.mean(axis=0) + start, beside + start))
    found.sort(key=lambda one: one[0])
    found = found[:_MOST_OBSTACLES]
    return Obstacles(
        np.array([one[1] for one in found]).reshape(-1, 2), np.array([one[2] for one in found]).reshape(-1, 2, 2)
    )


def signature_of(points: Array, obstacles: Obstacles) -> Signature:
    """Return how often a path (n, 2) winds around each obstacle, relative to the straight line between its ends."""
    winds = []
    for center in obstacles.centers:
        bearing = np.arctan2(*(points - center).T[::-1])
        swept = float(wrap(np.diff(bearing)).sum())
        direct = float(wrap(bearing[-1] - bearing[0]))
        winds.append(round((swept - direct) / (2.0 * math.pi)))
    return tuple(winds)


def distinct_paths(
    distance: Table,
    origin: Array,
    resolution: float,
    start: Array,
    goal: Array,
    obstacles: Obstacles,
    *,
    threshold: float,
    known: set[Signature],
    most: int,
) -> list[Array]:
    """Return paths (n, 2) from the start to the goal past the obstacles, each of a class of its own.

    Parameters
    ----------
    distance, origin, resolution, start, goal
        See `obstacles_beside`.
    obstacles : Obstacles
    threshold : float
        Cosine of the largest angle between a part of a path and the direction to the goal.
    known : set of tuple
        Classes that there are already; those of the new paths are added.
    most : int
        Number of paths.
    """
    points = np.concatenate([[start], obstacles.sides.reshape(-1, 2), [goal]])
    edges = _edges(points, distance, origin, resolution, threshold)
    found: list[Array] = []
    looked_at = 0
    stack: list[tuple[int, ...]] = [(0,)]
    while stack and len(found) < most and looked_at < _MOST_PATHS:
        way = stack.pop()
        if way[-1] == len(points) - 1:
            looked_at += 1
            path = _filled(points[list(way)], resolution)
            signature = signature_of(path, obstacles)
            if signature not in known:
                known.add(signature)
                found.append(path)
            continue
        # The shortest first: the stack gives its last one back first.
        nexts = sorted(edges[way[-1]], key=lambda j: -float(np.hypot(*(points[j] - points[way[-1]]))))
        stack += [(*way, j) for j in reversed(nexts) if j not in way]
    return found


def _edges(points: Array, distance: Table, origin: Array, resolution: float, threshold: float) -> list[list[int]]:
    """Return which points each point leads to: ahead, and past no obstacle."""
    goal = len(points) - 1
    to_goal = points[goal] - points[0]
    ahead = to_goal / max(math.hypot(*to_goal), 1e-9)
    edges: list[list[int]] = []
    for i, point in enumerate(points):
        leads_to = []
        for j in range(1, len(points)):
            step = points[j] - point
            length = math.hypot(*step)
            if i == goal or j == i or length < 1e-9 or step @ ahead < threshold * length:
                continue
            if is_free(np.stack([point, points[j]]), distance, origin, resolution):
                leads_to.append(j)
        edges.append(leads_to)
    return edges


@compiled
def is_free(points: Array, distance: Table, origin: Array, resolution: float) -> bool:
    """Return whether no obstacle lies on the line through points (n, 2)."""
    for i in range(points.shape[0] - 1):
        dx, dy = points[i + 1, 0] - points[i, 0], points[i + 1, 1] - points[i, 1]
        count = max(math.ceil(2.0 * math.hypot(dx, dy) / resolution), 1)  # so that none of the cells is left out
        for k in range(count + 1):
            column = math.floor((points[i, 0] + k / count * dx - origin[0]) / resolution)
            row = math.floor((points[i, 1] + k / count * dy - origin[1]) / resolution)
            inside = 0 <= column < distance.shape[1] and 0 <= row < distance.shape[0]
            if inside and distance[row, column] <= 0.5 * resolution:
                return False
    return True


def _filled(points: Array, spacing: float) -> Array:
    """Return the points with others between them, `spacing` [m] apart."""
    parts = [points[:1]]
    for one, other in itertools.pairwise(points):
        count = max(math.ceil(math.hypot(*(other - one)) / spacing), 1)
        parts.append(np.linspace(one, other, count + 1)[1:])
    return np.concatenate(parts)
