"""Points with normals, merged where they coincide and sorted into cells for nearest-neighbour search."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled

Indices = NDArray[np.int64]

MERGE_RADIUS = 0.04
"""Distance [m] within which points become one: their mean is less noisy, and fewer are faster to search."""

MERGE_COSINE = 0.95
"""Least cosine of the angle between the normals of points that become one."""


@dataclass(frozen=True)
class Reference:
    """Points with normals that a scan is matched against, sorted by cell.

    Attributes
    ----------
    points, normals : ndarray, shape (m, 2)
        Sorted so that the points of one cell follow each other.
    starts : ndarray, shape (rows * columns + 1,)
        Index of the first point of each cell, row by row.
    columns : int
        Number of cells per row.
    corner : ndarray, shape (2,)
        Lower left corner [m] of the first cell.
    cell : float
        Side of a cell [m]; neighbours up to this distance are found.
    """

    points: Array
    normals: Array
    starts: Indices
    columns: int
    corner: Array
    cell: float


def build_reference(points: Array, normals: Array, cell: float) -> Reference:
    """Merge and sort points (m, 2) with their normals; points without a normal are left out."""
    corner, columns, starts, sorted_points, sorted_normals = _sort(points, normals, float(cell))
    merged_points, merged_normals, merged_starts = _merge(sorted_points, sorted_normals, starts)
    return Reference(merged_points, merged_normals, merged_starts, columns, corner, float(cell))


@compiled
def _sort(points: Array, normals: Array, cell: float) -> tuple[Array, int, Indices, Array, Array]:
    usable = np.flatnonzero((normals[:, 0] != 0.0) | (normals[:, 1] != 0.0))
    corner = np.zeros(2)
    if usable.shape[0] == 0:
        return corner, 1, np.zeros(2, np.int64), np.empty((0, 2)), np.empty((0, 2))
    corner[0] = points[usable, 0].min()
    corner[1] = points[usable, 1].min()
    columns = int((points[usable, 0].max() - corner[0]) / cell) + 1
    rows = int((points[usable, 1].max() - corner[1]) / cell) + 1
    starts = np.zeros(rows * columns + 1, np.int64)
    cells = np.empty(usable.shape[0], np.int64)
    for k in range(usable.shape[0]):
        i = usable[k]
        column = int((points[i, 0] - corner[0]) / cell)
        row = int((points[i, 1] - corner[1]) / cell)
        cells[k] = row * columns + column
        starts[cells[k] + 1] += 1
    for c in range(rows * columns):
        starts[c + 1] += starts[c]
    filled = starts[:-1].copy()
    sorted_points = np.empty((usable.shape[0], 2))
    sorted_normals = np.empty((usable.shape[0], 2))
    for k in range(usable.shape[0]):
        slot = filled[cells[k]]
        filled[cells[k]] += 1
        sorted_points[slot] = points[usable[k]]
        sorted_normals[slot] = normals[usable[k]]
    return corner, columns, starts, sorted_points, sorted_normals


@compiled
def _merge(points: Array, normals: Array, starts: Indices) -> tuple[Array, Array, Indices]:
    """Within each cell, average the points that are near each other and face the same way."""
    count = points.shape[0]
    sums = np.empty((count, 2))
    directions = np.empty((count, 2))
    weights = np.empty(count)
    merged_starts = np.zeros_like(starts)
    used = 0
    for cell in range(starts.shape[0] - 1):
        first = used
        for i in range(starts[cell], starts[cell + 1]):
            k = first
            while k < used:
                dx = points[i, 0] - sums[k, 0] / weights[k]
                dy = points[i, 1] - sums[k, 1] / weights[k]
                along = normals[i, 0] * directions[k, 0] + normals[i, 1] * directions[k, 1]
                if dx * dx + dy * dy < MERGE_RADIUS**2 and along > MERGE_COSINE * weights[k]:
                    break
                k += 1
            if k == used:
                sums[k], directions[k], weights[k] = points[i], normals[i], 1.0
                used += 1
            else:
                sums[k] += points[i]
                directions[k] += normals[i]
                weights[k] += 1.0
        merged_starts[cell + 1] = used
    for k in range(used):
        sums[k] /= weights[k]
        directions[k] /= np.hypot(directions[k, 0], directions[k, 1])
    return sums[:used].copy(), directions[:used].copy(), merged_starts
