"""Motions of a state lattice as arrays for its search, turned to the heading of a start."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.navigation.planners.goal_curves import SPACING
from daidalos.navigation.planners.state_lattice import MotionPrimitive, StateLattice


class LatticeMotions:
    """Motions by the heading at which they begin; positions are in cells of a costmap.

    Parameters
    ----------
    lattice : StateLattice
    yaw : float
        Heading of the start [rad]; the lattice is turned so that its nearest heading is this.
    resolution : float
        Of the costmap [m].
    reach : float
        Distance [cells] from the robot's centre to the farthest point of its footprint, for turns in place.
    is_reverse_allowed : bool
        Whether motions are driven backwards too.

    Attributes
    ----------
    first : int
        Heading of the start.
    offset : float
        Angle [rad] by which the lattice is turned.
    scale : float
        Edge of the lattice's cells in those of the costmap.
    headings : ndarray, shape (n,)
        Angles of the headings, turned [rad].
    begin : ndarray of int64, shape (n + 1,)
        Where the motions from each heading begin.
    ends : ndarray of int32, shape (m, 5)
        Columns, rows, heading at the end, side of the turn (1 left, -1 right, 0 none), whether it is driven backwards.
    lengths : ndarray, shape (m,)
    first_poses : ndarray of int64, shape (m + 1,)
        Where the poses of each motion begin.
    poses : ndarray, shape (k, 3)
        Poses along the motions from where they begin, turned.
    most : int
        Largest number of motions from a heading.
    """

    def __init__(
        self, lattice: StateLattice, yaw: float, resolution: float, reach: float, *, is_reverse_allowed: bool
    ) -> None:
        self.first = lattice.nearest_heading(yaw)
        self.offset = yaw - float(lattice.headings[self.first])
        self.scale = lattice.grid_resolution / resolution
        self.headings = lattice.headings + self.offset
        count = lattice.headings.size
        driven: list[tuple[int, MotionPrimitive, int]] = [(one.start, one, 0) for one in lattice.primitives]
        if is_reverse_allowed:
            half = count // 2
            driven += [((one.start + half) % count, one, 1) for one in lattice.primitives if one.length > 0.0]
        driven.sort(key=lambda one: (one[0], one[2]))
        self.begin = np.searchsorted([one[0] for one in driven], np.arange(count + 1)).astype(np.int64)
        self.most = int(np.diff(self.begin).max())
        self.lengths = np.array([one.length for _, one, _ in driven]) / resolution
        self.ends = np.array([self._end(lattice, one, reverse) for _, one, reverse in driven], dtype=np.int32)
        parts = [self._turned(lattice, one, reverse, resolution, reach) for _, one, reverse in driven]
        self.first_poses = np.cumsum([0, *(part.shape[0] for part in parts)]).astype(np.int64)
        self.poses = np.concatenate(parts)

    def _end(self, lattice: StateLattice, one: MotionPrimitive, reverse: int) -> tuple[int, ...]:
        column, row = np.round(one.poses[-1, :2] / lattice.grid_resolution).astype(int).tolist()
        count = lattice.headings.size
        return column, row, (one.end + reverse * count // 2) % count, -one.turn if reverse else one.turn, reverse

    def _turned(
        self, lattice: StateLattice, one: MotionPrimitive, reverse: int, resolution: float, reach: float
    ) -> Array:
        """Return the poses (n, 3) of a motion as they are driven, dense enough to check for collisions."""
        first = np.array([[0.0, 0.0, lattice.headings[one.start]]])
        poses = densified(np.concatenate([first, one.poses]), SPACING * resolution, reach * resolution)
        poses[-1, :2] = np.round(one.poses[-1, :2] / lattice.grid_resolution) * lattice.grid_resolution
        poses[:, 2] += self.offset + math.pi * reverse
        poses[:, :2] = self._rotated(poses[:, :2]) / resolution
        return poses

    def _rotated(self, points: Array) -> Array:
        cosine, sine = math.cos(self.offset), math.sin(self.offset)
        turned: Array = points @ np.array([[cosine, sine], [-sine, cosine]])
        return turned

    def poses_of(self, motion: int) -> Array:
        """Return the poses (n, 3) of a motion."""
        return self.poses[self.first_poses[motion] : self.first_poses[motion + 1]]

    def place(self, start: Array, node: NDArray[np.int32]) -> Array:
        """Return the position of a node (column, row) in cells of the costmap."""
        return start[:2] + self._rotated(np.asarray(node, dtype=np.float64) * self.scale)

    def extent(self, shape: tuple[int, ...], start: Array) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return the lowest and the highest column and row of nodes on a costmap of a shape (height, width)."""
        edges = np.array([[x, y] for x in (-0.5, shape[1] - 0.5) for y in (-0.5, shape[0] - 0.5)])
        cosine, sine = math.cos(self.offset), math.sin(self.offset)
        corners = (edges - start[:2]) @ np.array([[cosine, -sine], [sine, cosine]]) / self.scale
        low, high = np.floor(corners.min(axis=0)), np.ceil(corners.max(axis=0))
        return low.astype(np.int64), high.astype(np.int64)


def densified(poses: Array, spacing: float, reach: float) -> Array:
    """Return poses (n, 3) along a motion, the first left out, with others between them at a constant twist.

    Parameters
    ----------
    poses : ndarray, shape (m, 3)
    spacing : float
        Largest distance between poses, and between places of one point of the robot while it turns in place.
    reach : float
        Distance of that point from the robot's centre.
    """
    found = []
    for (x, y, yaw), (to_x, to_y, to_yaw) in pairwise(poses):
        turn = math.remainder(to_yaw - yaw, 2.0 * math.pi)
        apart = math.hypot(to_x - x, to_y - y)
        if apart < 1e-9 and abs(turn) < 1e-9:
            continue
        along = apart if apart > 1e-9 else abs(turn) * reach
        count = max(math.ceil(along / spacing - 1e-6), 1)
        # An arc is swept while the chord from its beginning turns by half of what the heading does.
        chord = math.atan2(to_y - y, to_x - x)
        for k in range(1, count + 1):
            share = k / count
            length = apart * (math.sin(0.5 * turn * share) / math.sin(0.5 * turn) if abs(turn) > 1e-9 else share)
            angle = chord - 0.5 * turn * (1.0 - share)
            found.append((x + length * math.cos(angle), y + length * math.sin(angle), yaw + turn * share))
    return np.array(found)
