"""Kernels of `daidalos.industry.motion.orientations`: one loop over quaternions x, y, z, w each.

An argument with one row stands for as many as the others have.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from daidalos.common.kernels import compiled

_SMALL = 1e-12

Array = NDArray[np.float64]


@compiled(inline=True)
def _multiply(a: Array, b: Array, out: Array) -> None:
    """Compute one product."""
    x1, y1, z1, w1 = a[0], a[1], a[2], a[3]
    x2, y2, z2, w2 = b[0], b[1], b[2], b[3]
    out[0] = w1 * x2 + x1 * w2 + y1 * z2 - z1 * y2
    out[1] = w1 * y2 - x1 * z2 + y1 * w2 + z1 * x2
    out[2] = w1 * z2 + x1 * y2 - y1 * x2 + z1 * w2
    out[3] = w1 * w2 - x1 * x2 - y1 * y2 - z1 * z2


@compiled
def multiply_kernel(a: Array, b: Array, out: Array) -> None:
    """Compute products."""
    step_a, step_b = int(a.shape[0] > 1), int(b.shape[0] > 1)
    for n in range(out.shape[0]):
        _multiply(a[n * step_a], b[n * step_b], out[n])


@compiled
def slerp_kernel(start: Array, end: Array, shares: Array, out: Array) -> None:
    """Turn each start by a share of the shorter rotation to the end."""
    step_start, step_end = int(start.shape[0] > 1), int(end.shape[0] > 1)
    between, turn = np.empty(4), np.empty(4)
    for n in range(out.shape[0]):
        first = start[n * step_start]
        inverse = np.array([-first[0], -first[1], -first[2], first[3]])
        _multiply(inverse, end[n * step_end], between)
        sign = -1.0 if between[3] < 0.0 else 1.0
        sine = math.sqrt(between[0] ** 2 + between[1] ** 2 + between[2] ** 2)
        half = math.atan2(sine, sign * between[3])
        scale = sign * math.sin(shares[n] * half) / sine if sine > _SMALL else sign * shares[n]
        for k in range(3):
            turn[k] = scale * between[k]
        turn[3] = math.cos(shares[n] * half)
        _multiply(first, turn, out[n])
