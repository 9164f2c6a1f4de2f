"""Random fields of posts in the manner of BARN's generator: cellular automata of which a robot finds a way through."""

from __future__ import annotations

import heapq
import math

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array

SIZE = 30
"""Cells of a field along each side."""

WALL_ROWS = 34
"""Cells of the walls before the field, between which the robot starts."""

_FILLS = (0.22, 0.26, 0.30, 0.34)
_ROUNDS = 3
_BORN, _KEPT = 5, 3
_HALF_WIDTH = 2
"""Cells that have to be free on both sides of the way."""


def random_field(seed: int) -> tuple[NDArray[np.bool_], Array]:
    """Return which cells have posts, and the shortest way through them.

    Parameters
    ----------
    seed : int

    Returns
    -------
    filled : array (SIZE, SIZE) of bool
        By row, the nearest to the start first, and column.
    path : array (n, 2)
        Columns and rows of the way from the first row to the last.
    """
    stream = np.random.default_rng(seed)
    while True:
        filled = stream.random((SIZE, SIZE)) < stream.choice(_FILLS)
        for _ in range(_ROUNDS):
            around = neighbours(filled)
            filled = (around >= _BORN) | (filled & (around >= _KEPT))
        filled[:, (0, -1)] = True
        path = shortest_way(widened(filled, _HALF_WIDTH))
        if path is not None:
            return filled, path


def neighbours(filled: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Return how many of the 8 cells around each are filled."""
    padded = np.pad(filled.astype(int), 1)
    height, width = filled.shape
    shifts = [(i, j) for i in range(3) for j in range(3) if (i, j) != (1, 1)]
    counts: NDArray[np.int64] = np.sum([padded[i : i + height, j : j + width] for i, j in shifts], axis=0)
    return counts


def widened(filled: NDArray[np.bool_], cells: int) -> NDArray[np.bool_]:
    """Return the cells that are filled, or nearer than so many cells to one that is."""
    height, width = filled.shape
    padded = np.pad(filled, cells)
    reach = range(-cells, cells + 1)
    found = np.zeros_like(filled)
    for i in reach:
        for j in reach:
            if math.hypot(i, j) <= cells:
                found |= padded[cells + i : cells + i + height, cells + j : cells + j + width]
    return found


def shortest_way(blocked: NDArray[np.bool_]) -> Array | None:
    """Return columns and rows (n, 2) of the shortest way from the first row to the last; None where there is none."""
    height, width = blocked.shape
    best = {(0, column): 0.0 for column in range(width) if not blocked[0, column]}
    before: dict[tuple[int, int], tuple[int, int]] = {}
    queue = [(0.0, cell) for cell in best]
    while queue:
        length, cell = heapq.heappop(queue)
        if length > best[cell]:
            continue
        if cell[0] == height - 1:
            way = [cell]
            while way[-1] in before:
                way.append(before[way[-1]])
            return np.array(way[::-1], dtype=float)[:, ::-1]
        for i, j in ((1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (1, -1), (-1, 1), (-1, -1)):
            row, column = cell[0] + i, cell[1] + j
            if not (0 <= row < height and 0 <= column < width) or blocked[row, column]:
                continue
            further = length + math.hypot(i, j)
            if further < best.get((row, column), math.inf):
                best[row, column] = further
                before[row, column] = cell
                heapq.heappush(queue, (further, (row, column)))
    return None
