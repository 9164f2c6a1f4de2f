"""Likelihood grids for correlative matching, with upper bounds over windows of increasing size."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled

Cells = NDArray[np.uint8]

FULL = 255
"""Value of a cell that holds a point."""


@dataclass(frozen=True)
class Likelihood:
    """Likelihood that a beam ends in each cell.

    Attributes
    ----------
    levels : ndarray of uint8, shape (depth + 1, rows, columns)
        `levels[0]` is the likelihood from 0 to 255; `levels[k][r, c]` is the largest value of `levels[0]` in
        the window of 2**k x 2**k cells that begins at (r, c).
    corner : ndarray, shape (2,)
        Lower left corner [m] of cell (0, 0).
    resolution : float
        Side of a cell [m].
    """

    levels: Cells
    corner: Array
    resolution: float


def build_likelihood(points: Array, resolution: float, deviation: float, depth: int) -> Likelihood:
    """Convolve points (m, 2) with a Gaussian of a standard deviation [m] and build the upper bounds."""
    margin = 2.0 * deviation + 2.0 * resolution
    # A window may begin left of or below every point and still hold one: room for it on those sides.
    corner = points.min(axis=0) - margin - (1 << depth) * resolution
    columns, rows = np.ceil((points.max(axis=0) + margin - corner) / resolution).astype(int)
    levels = np.zeros((depth + 1, int(rows), int(columns)), np.uint8)
    _blur(points, levels[0], corner, float(resolution), _kernel(resolution, deviation))
    for level in range(1, depth + 1):
        _widen(levels[level - 1], levels[level], 1 << (level - 1))
    return Likelihood(levels, corner, float(resolution))


def _kernel(resolution: float, deviation: float) -> Cells:
    half = int(np.ceil(2.0 * deviation / resolution))
    distance = np.arange(-half, half + 1) * resolution
    square = distance[:, None] ** 2 + distance[None, :] ** 2
    kernel: Cells = np.round(FULL * np.exp(-0.5 * square / deviation**2)).astype(np.uint8)
    return kernel


@compiled
def _blur(points: Array, cells: Cells, corner: Array, resolution: float, kernel: Cells) -> None:
    rows, columns = cells.shape
    half = kernel.shape[0] // 2
    for i in range(points.shape[0]):
        column = int(np.floor((points[i, 0] - corner[0]) / resolution))
        row = int(np.floor((points[i, 1] - corner[1]) / resolution))
        if 0 <= row < rows and 0 <= column < columns and cells[row, column] == FULL:
            continue
        for dr in range(-half, half + 1):
            r = row + dr
            if r < 0 or r >= rows:
                continue
            for dc in range(-half, half + 1):
                c = column + dc
                if 0 <= c < columns and kernel[dr + half, dc + half] > cells[r, c]:
                    cells[r, c] = kernel[dr + half, dc + half]


@compiled
def _widen(narrow: Cells, wide: Cells, step: int) -> None:
    """Return the maxima over windows twice as wide, from the four windows of the narrower level that tile each."""
    rows, columns = narrow.shape
    for r in range(rows):
        below = min(r + step, rows - 1) if r + step < rows else -1
        for c in range(columns):
            value = narrow[r, c]
            right = c + step
            if right < columns:
                value = max(value, narrow[r, right])
            if below >= 0:
                value = max(value, narrow[below, c])
                if right < columns:
                    value = max(value, narrow[below, right])
            wide[r, c] = value
