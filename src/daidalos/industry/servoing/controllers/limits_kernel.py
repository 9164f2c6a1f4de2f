"""Kernel that keeps the solution of a least-squares problem within limits of linear functions of it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daidalos.common.kernels import compiled

Array = NDArray[np.float64]


@compiled
def limit_prices(
    coupling: Array, values: Array, lower: Array, upper: Array, prices: Array, sweeps: int, tolerance: float
) -> None:
    """Compute the prices of limits, one after the other, until none of them changes a value by more than a tolerance.

    C. Hildreth, "A quadratic programming procedure", 1957: coordinate ascent of the dual problem.

    Parameters
    ----------
    coupling : array of shape (m, m)
        How much each price lowers each value.
    values : array of shape (m,)
        Values of the limited functions; in the end with the prices.
    lower, upper : arrays of shape (m,)
        Limits.
    prices : array of shape (m,)
        Those to begin with, which `values` hold already; in the end those found.
    sweeps : int
        Greatest number of passes.
    """
    for _ in range(sweeps):
        change = 0.0
        for i in range(len(prices)):
            free = values[i] + coupling[i, i] * prices[i]
            price = 0.0
            if free > upper[i]:
                price = (free - upper[i]) / coupling[i, i]
            elif free < lower[i]:
                price = (free - lower[i]) / coupling[i, i]
            step = price - prices[i]
            if step != 0.0:
                prices[i] = price
                change = max(change, abs(step) * coupling[i, i])
                for j in range(len(prices)):
                    values[j] -= coupling[j, i] * step
        if change < tolerance:
            return
