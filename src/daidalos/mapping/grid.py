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

TILE = 32
"""Side [cells] of a tile. Only tiles that a beam has touched have counts, not the whole rectangle around them."""

SPARE_TILES = 256
"""Least number of tiles by which the counts grow beyond what is needed, so that they grow rarely."""


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
        self._tiles: Counts = np.zeros((0, 0), np.int32)
        """Number of each tile in the counts, by its row and column; 0 where no beam has touched it."""
        self._hits: Counts = np.zeros((1, TILE, TILE), np.int32)
        self._misses: Counts = np.zeros((1, TILE, TILE), np.int32)
        self._count = 1
        self._corner = np.zeros(2, np.int64)

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
        counts = self._tiles, self._hits, self._misses
        minimum = max(1, min_pass_through)
        left, bottom, right, top = _known_bounds(*counts, minimum)
        if right < left:
            return self._empty()
        data = np.full((top - bottom + 1, right - left + 1), UNKNOWN, np.int8)
        _classify(*counts, left, bottom, float(occupancy_threshold), minimum, data)
        x, y = (self._corner + np.array([left, bottom])) * self.resolution
        return OccupancyGrid(data, self.resolution, (float(x), float(y), 0.0))

    def _empty(self) -> OccupancyGrid:
        return OccupancyGrid(np.zeros((0, 0), np.int8), self.resolution, (0.0, 0.0, 0.0))

    def _trace(self, cloud: Cloud, pose: Array, sign: int) -> None:
        placed = np.array(pose, dtype=np.float64)
        self._make_room(beam_bounds(cloud.ends, cloud.cleared, cloud.origin, placed, self.resolution))
        for ends, is_hit in ((cloud.ends, True), (cloud.cleared, False)):
            self._count = _count_in_tiles(
                ends,
                cloud.origin,
                placed,
                self.resolution,
                self._corner,
                self._tiles,
                self._hits,
                self._misses,
                self._count,
                sign,
                is_hit,
            )

    def _make_room(self, bounds: NDArray[np.int64]) -> None:
        """Make room for all tiles of a rectangle of cells: left, bottom, right, top."""
        first = bounds[:2] // TILE * TILE
        corner = np.minimum(self._corner, first) if self._tiles.size else first
        column, row = (self._corner - corner) // TILE if self._tiles.size else (0, 0)
        old_rows, old_columns = self._tiles.shape
        columns, rows = np.maximum((bounds[2:] - corner) // TILE + 1, (column + old_columns, row + old_rows))
        if (rows, columns) != self._tiles.shape:
            tiles = np.zeros((rows, columns), np.int32)
            tiles[row : row + old_rows, column : column + old_columns] = self._tiles
            self._tiles, self._corner = tiles, corner
        left, bottom = (bounds[:2] - self._corner) // TILE
        right, top = (bounds[2:] - self._corner) // TILE + 1
        needed = self._count + int(np.count_nonzero(self._tiles[bottom:top, left:right] == 0))
        if needed > len(self._hits):
            spare = max(SPARE_TILES, len(self._hits) // 8)
            more = np.zeros((needed - len(self._hits) + spare, TILE, TILE), np.int32)
            self._hits, self._misses = (np.concatenate([old, more]) for old in (self._hits, self._misses))


def draw_scans(clouds: Sequence[Cloud], poses: Array, resolution: float) -> OccupancyGrid:
    """Draw scans at poses (n, 3) as one map with cells of a resolution [m]."""
    grid = ScanGrid(resolution)
    for cloud, pose in zip(clouds, poses, strict=True):
        grid.add(cloud, pose)
    return grid.classify()


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
    """Count beams along their cells, in arrays whose first cell is at a corner."""
    start, stops = _in_cells(ends, origin, pose, resolution, corner)
    cells = np.empty((_longest(start, stops) + 1, 2), np.int64)
    for i in range(stops.shape[0]):
        last = _trace_beam(start[0], start[1], stops[i, 0], stops[i, 1], cells)
        for k in range(last):
            misses[cells[k, 1], cells[k, 0]] += sign
        (hits if is_hit else misses)[cells[last, 1], cells[last, 0]] += sign


@compiled
def _count_in_tiles(
    ends: Array,
    origin: Array,
    pose: Array,
    resolution: float,
    corner: NDArray[np.int64],
    tiles: Counts,
    hits: Counts,
    misses: Counts,
    count: int,
    sign: int,
    is_hit: bool,
) -> int:
    """Count beams along their cells, in tiles that are taken into use where needed; return how many are in use."""
    start, stops = _in_cells(ends, origin, pose, resolution, corner)
    cells = np.empty((_longest(start, stops) + 1, 2), np.int64)
    for i in range(stops.shape[0]):
        last = _trace_beam(start[0], start[1], stops[i, 0], stops[i, 1], cells)
        for k in range(last + 1):
            column, row = cells[k, 0], cells[k, 1]
            tile = tiles[row // TILE, column // TILE]
            if tile == 0:
                tile = count
                tiles[row // TILE, column // TILE] = tile
                count += 1
            if k == last and is_hit:
                hits[tile, row % TILE, column % TILE] += sign
            else:
                misses[tile, row % TILE, column % TILE] += sign
    return count


@compiled
def _in_cells(
    ends: Array, origin: Array, pose: Array, resolution: float, corner: NDArray[np.int64]
) -> tuple[Array, Array]:
    """Return where beams start (2,) and end (n, 2), in cells from a corner."""
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    start = np.empty(2)
    start[0] = (pose[0] + cosine * origin[0] - sine * origin[1]) / resolution - corner[0]
    start[1] = (pose[1] + sine * origin[0] + cosine * origin[1]) / resolution - corner[1]
    stops = np.empty((ends.shape[0], 2))
    for i in range(ends.shape[0]):
        stops[i, 0] = (pose[0] + cosine * ends[i, 0] - sine * ends[i, 1]) / resolution - corner[0]
        stops[i, 1] = (pose[1] + sine * ends[i, 0] + cosine * ends[i, 1]) / resolution - corner[1]
    return start, stops


@compiled
def _longest(start: Array, stops: Array) -> int:
    """Return the largest number of borders that a beam crosses."""
    longest = 0
    for i in range(stops.shape[0]):
        crossed = abs(np.floor(stops[i, 0]) - np.floor(start[0])) + abs(np.floor(stops[i, 1]) - np.floor(start[1]))
        longest = max(longest, int(crossed))
    return longest


@compiled
def _trace_beam(start_x: float, start_y: float, end_x: float, end_y: float, cells: NDArray[np.int64]) -> int:
    """Fill in the cells (column, row) of a beam; return the index of the last (Amanatides, Woo 1987).

    "A fast voxel traversal algorithm for ray tracing".
    """
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
    count = abs(last_column - column) + abs(last_row - row)
    for k in range(count):
        cells[k, 0], cells[k, 1] = column, row
        if next_x < next_y:
            column += step_x
            next_x += across_x
        else:
            row += step_y
            next_y += across_y
    cells[count, 0], cells[count, 1] = last_column, last_row
    return count


@compiled
def _known_bounds(tiles: Counts, hits: Counts, misses: Counts, minimum: int) -> tuple[int, int, int, int]:
    """Return the first and last column and row of cells that enough beams have reached: left, bottom, right, top."""
    left, bottom, right, top = tiles.shape[1] * TILE, tiles.shape[0] * TILE, -1, -1
    for tile_row in range(tiles.shape[0]):
        for tile_column in range(tiles.shape[1]):
            tile = tiles[tile_row, tile_column]
            if tile == 0:
                continue
            for r in range(TILE):
                for c in range(TILE):
                    if hits[tile, r, c] + misses[tile, r, c] >= minimum:
                        left, right = min(left, tile_column * TILE + c), max(right, tile_column * TILE + c)
                        bottom, top = min(bottom, tile_row * TILE + r), max(top, tile_row * TILE + r)
    return left, bottom, right, top


@compiled
def _classify(
    tiles: Counts,
    hits: Counts,
    misses: Counts,
    left: int,
    bottom: int,
    threshold: float,
    minimum: int,
    data: Occupancy,
) -> None:
    """Fill in a map whose first cell is at a column and a row, and which covers all known cells."""
    for tile_row in range(tiles.shape[0]):
        for tile_column in range(tiles.shape[1]):
            tile = tiles[tile_row, tile_column]
            if tile == 0:
                continue
            for r in range(TILE):
                for c in range(TILE):
                    total = hits[tile, r, c] + misses[tile, r, c]
                    if total >= minimum:
                        is_occupied = hits[tile, r, c] > threshold * total
                        data[tile_row * TILE + r - bottom, tile_column * TILE + c - left] = 100 if is_occupied else 0
