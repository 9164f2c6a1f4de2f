"""Occupancy grids of beams counted per cell, from which single scans can be removed again."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.mapping.scan import Cloud

Counts = NDArray[np.int32]
Occupancy = NDArray[np.int8]

UNKNOWN, FREE, OCCUPIED = -1, 0, 100

MARGIN = 64
"""Cells by which the counts grow beyond what is needed, so that they grow rarely."""


@dataclass(frozen=True)
class OccupancyGrid:
    """A map as `nav_msgs/OccupancyGrid` carries it.

    Attributes
    ----------
    data : ndarray of int8, shape (rows, columns)
        -1 unknown, 0 free to 100 occupied; row 0 is the lowest y.
    resolution : float
        Side of a cell [m].
    origin : tuple of float
        Pose (x, y, yaw) of the lower left corner of cell (0, 0).
    frame : str
        Frame of the origin; empty where it is not told.
    """

    data: Occupancy
    resolution: float
    origin: tuple[float, float, float]
    frame: str = ""


class ScanGrid:
    """Counts of beams that ended in and passed through each cell.

    The counts are whole numbers, so a scan is taken out by tracing the same beams again: after a loop closure
    each scan moves by itself, and the map is whole in between.

    Parameters
    ----------
    resolution : float
        Side of a cell [m].
    """

    def __init__(self, resolution: float) -> None:
        self.resolution = resolution
        self._hits: Counts = np.zeros((0, 0), np.int32)
        self._misses: Counts = np.zeros((0, 0), np.int32)
        self._corner = np.zeros(2, np.int64)
        self._used: NDArray[np.int64] | None = None

    def add(self, cloud: Cloud, pose: Array) -> None:
        """Count the beams of a scan at a pose (x, y, yaw)."""
        self._trace(cloud, pose, 1)

    def remove(self, cloud: Cloud, pose: Array) -> None:
        """Remove the beams of a scan that was added at exactly this pose."""
        self._trace(cloud, pose, -1)

    def classify(self, occupancy_threshold: float = 0.1, min_pass_through: int = 2) -> OccupancyGrid:
        """Classify cells as occupied, free or unknown by the ratio of the beams that ended in them.

        The grid spans the known cells; without any it has none.

        Parameters
        ----------
        occupancy_threshold : float
            Share above which a cell is occupied.
        min_pass_through : int
            Beams that must have reached a cell for it to be known.
        """
        if self._used is None:
            return self._empty()
        bounds = self._used - np.tile(self._corner, 2)
        data = _classify(self._hits, self._misses, bounds, float(occupancy_threshold), int(min_pass_through))
        rows = np.flatnonzero((data != UNKNOWN).any(axis=1))
        columns = np.flatnonzero((data != UNKNOWN).any(axis=0))
        if rows.size == 0:
            return self._empty()
        known = np.ascontiguousarray(data[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1])
        left, bottom = (self._used[:2] + np.array([columns[0], rows[0]])) * self.resolution
        return OccupancyGrid(known, self.resolution, (float(left), float(bottom), 0.0))

    def _empty(self) -> OccupancyGrid:
        return OccupancyGrid(np.zeros((0, 0), np.int8), self.resolution, (0.0, 0.0, 0.0))

    def _trace(self, cloud: Cloud, pose: Array, sign: int) -> None:
        placed = np.array(pose, dtype=np.float64)
        self._make_room(beam_bounds(cloud.ends, cloud.cleared, cloud.origin, placed, self.resolution))
        count_beams(
            cloud.ends,
            cloud.origin,
            placed,
            self.resolution,
            self._corner,
            self._hits,
            self._misses,
            sign,
            True,
        )
        count_beams(
            cloud.cleared,
            cloud.origin,
            placed,
            self.resolution,
            self._corner,
            self._hits,
            self._misses,
            sign,
            False,
        )

    def _make_room(self, bounds: NDArray[np.int64]) -> None:
        if self._used is None:
            self._used = bounds.copy()
        self._used[:2] = np.minimum(self._used[:2], bounds[:2])
        self._used[2:] = np.maximum(self._used[2:], bounds[2:])
        rows, columns = self._hits.shape
        end = self._corner + np.array([columns, rows])
        if rows and np.all(bounds[:2] >= self._corner) and np.all(bounds[2:] < end):
            return
        corner = self._used[:2] - MARGIN
        size = self._used[2:] + 1 + MARGIN - corner
        grown: list[Counts] = []
        for old in (self._hits, self._misses):
            new = np.zeros((int(size[1]), int(size[0])), np.int32)
            column, row = self._corner - corner
            if rows:
                _copy_known(old, new, int(row), int(column))
            grown.append(new)
        self._hits, self._misses = grown
        self._corner = corner


def draw_scans(clouds: Sequence[Cloud], poses: Array, resolution: float) -> OccupancyGrid:
    """Draw scans at poses (n, 3) as one map with cells of a resolution [m]."""
    grid = ScanGrid(resolution)
    for cloud, pose in zip(clouds, poses, strict=True):
        grid.add(cloud, pose)
    return grid.classify()


def _copy_known(old: Counts, new: Counts, row: int, column: int) -> None:
    """Copy the part of the old counts that the new ones cover; the rest lies in an unused margin."""
    top, left = max(row, 0), max(column, 0)
    bottom = min(row + old.shape[0], new.shape[0])
    right = min(column + old.shape[1], new.shape[1])
    new[top:bottom, left:right] = old[top - row : bottom - row, left - column : right - column]


@compiled
def beam_bounds(points: Array, cleared: Array, origin: Array, pose: Array, resolution: float) -> NDArray[np.int64]:
    """Return the first and last column and row that the beams touch: left, bottom, right, top."""
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    x = pose[0] + cosine * origin[0] - sine * origin[1]
    y = pose[1] + sine * origin[0] + cosine * origin[1]
    low_x = high_x = x
    low_y = high_y = y
    for ends in (points, cleared):
        for i in range(ends.shape[0]):
            x = pose[0] + cosine * ends[i, 0] - sine * ends[i, 1]
            y = pose[1] + sine * ends[i, 0] + cosine * ends[i, 1]
            low_x = min(low_x, x)
            high_x = max(high_x, x)
            low_y = min(low_y, y)
            high_y = max(high_y, y)
    bounds = np.empty(4, np.int64)
    bounds[0] = int(np.floor(low_x / resolution))
    bounds[1] = int(np.floor(low_y / resolution))
    bounds[2] = int(np.floor(high_x / resolution))
    bounds[3] = int(np.floor(high_y / resolution))
    return bounds


@compiled
def count_beams(
    ends: Array,
    origin: Array,
    pose: Array,
    resolution: float,
    corner: NDArray[np.int64],
    hits: Counts,
    misses: Counts,
    sign: int,
    is_hit: bool,
) -> None:
    """Count beams along their cells (Amanatides, Woo 1987: "A fast voxel traversal algorithm")."""
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    start_x = (pose[0] + cosine * origin[0] - sine * origin[1]) / resolution - corner[0]
    start_y = (pose[1] + sine * origin[0] + cosine * origin[1]) / resolution - corner[1]
    for i in range(ends.shape[0]):
        end_x = (pose[0] + cosine * ends[i, 0] - sine * ends[i, 1]) / resolution - corner[0]
        end_y = (pose[1] + sine * ends[i, 0] + cosine * ends[i, 1]) / resolution - corner[1]
        column, row = int(np.floor(start_x)), int(np.floor(start_y))
        last_column, last_row = int(np.floor(end_x)), int(np.floor(end_y))
        dx, dy = end_x - start_x, end_y - start_y
        step_x = 1 if dx > 0.0 else -1
        step_y = 1 if dy > 0.0 else -1
        # Share of the beam between two crossings of cell borders, and up to the first one.
        across_x = 1.0 / abs(dx) if dx != 0.0 else np.inf
        across_y = 1.0 / abs(dy) if dy != 0.0 else np.inf
        next_x = (column + (step_x > 0) - start_x) / dx if dx != 0.0 else np.inf
        next_y = (row + (step_y > 0) - start_y) / dy if dy != 0.0 else np.inf
        for _ in range(abs(last_column - column) + abs(last_row - row)):
            misses[row, column] += sign
            if next_x < next_y:
                column += step_x
                next_x += across_x
            else:
                row += step_y
                next_y += across_y
        if is_hit:
            hits[last_row, last_column] += sign
        else:
            misses[last_row, last_column] += sign


@compiled
def _classify(hits: Counts, misses: Counts, bounds: NDArray[np.int64], threshold: float, minimum: int) -> Occupancy:
    left, bottom, right, top = bounds
    data = np.full((top - bottom + 1, right - left + 1), np.int8(-1), np.int8)
    for r in range(data.shape[0]):
        for c in range(data.shape[1]):
            hit = hits[bottom + r, left + c]
            total = hit + misses[bottom + r, left + c]
            if total < minimum or total == 0:
                continue
            data[r, c] = 100 if hit > threshold * total else 0
    return data
