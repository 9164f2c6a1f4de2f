"""Kernels of cubic splines through equally spaced points, which end without a knot (not-a-knot), over columns."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daidalos.common.kernels import compiled

Array = NDArray[np.float64]


@compiled
def spline_slopes(step: float, values: Array, slopes: Array) -> None:
    """Compute the slopes (n, columns) of splines through values (n, columns), with n of 4 at least."""
    n, columns = values.shape
    weights = np.empty(n)
    weights[0] = 2.0
    for i in range(1, n - 1):
        weights[i] = 1.0 / (4.0 - weights[i - 1])
    for k in range(columns):
        slopes[0, k] = (-5.0 * values[0, k] + 4.0 * values[1, k] + values[2, k]) / (2.0 * step)
        for i in range(1, n - 1):
            right = 3.0 * (values[i + 1, k] - values[i - 1, k]) / step
            slopes[i, k] = (right - slopes[i - 1, k]) * weights[i]
        last = (5.0 * values[n - 1, k] - 4.0 * values[n - 2, k] - values[n - 3, k]) / (2.0 * step)
        slopes[n - 1, k] = (last - 2.0 * slopes[n - 2, k]) / (1.0 - 2.0 * weights[n - 2])
        for i in range(n - 2, -1, -1):
            slopes[i, k] -= weights[i] * slopes[i + 1, k]


@compiled
def spline_values(
    start: float, step: float, values: Array, slopes: Array, x: Array, out: Array, first: Array, second: Array
) -> None:
    """Compute values, first and second derivatives (m, columns) of splines at places x (m,)."""
    n, columns = values.shape
    for row in range(x.shape[0]):
        i = min(max(int((x[row] - start) / step), 0), n - 2)
        u = (x[row] - start) / step - i
        for k in range(columns):
            a, b = values[i, k], values[i + 1, k]
            c, d = slopes[i, k] * step, slopes[i + 1, k] * step
            square = 3.0 * (b - a) - 2.0 * c - d
            cube = 2.0 * (a - b) + c + d
            out[row, k] = a + u * (c + u * (square + u * cube))
            first[row, k] = (c + u * (2.0 * square + 3.0 * u * cube)) / step
            second[row, k] = (2.0 * square + 6.0 * u * cube) / step**2
