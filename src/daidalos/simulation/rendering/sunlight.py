"""Visibility of the sun at surface points: compiled lookups in a shadow map.

A shadow map has a coarse copy: the nearest depth in blocks of 2**BLOCK_BITS pixels a side.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from daidalos.common.kernels import compiled

BLOCK_BITS = 4
_MAX_BLOCKS = 16
"""Number of blocks above which a run of pixels is tested pixel by pixel."""


@compiled(fastmath=True)
def aim_at_shadow(to_shadow: Any, offset: Any, pose: Any, nx: Any, ny: Any, nz: Any, dy: Any, fx: Any, cx: Any) -> Any:
    """Return shadow-map coordinates of the pixels x of a row: (a x + b) z + c for column, row and depth.

    They are looked up a little off the surface, along its normal and towards the light.
    """
    wx = offset[0] * (pose[0, 0] * nx + pose[0, 1] * ny + pose[0, 2] * nz)
    wy = offset[0] * (pose[1, 0] * nx + pose[1, 1] * ny + pose[1, 2] * nz)
    wz = offset[0] * (pose[2, 0] * nx + pose[2, 1] * ny + pose[2, 2] * nz)
    m = to_shadow
    return (
        m[0, 0] / fx,
        m[0, 1] * dy + m[0, 2] - m[0, 0] * cx / fx,
        m[0, 3] + m[0, 0] * wx + m[0, 1] * wy + m[0, 2] * wz,
        m[1, 0] / fx,
        m[1, 1] * dy + m[1, 2] - m[1, 0] * cx / fx,
        m[1, 3] + m[1, 0] * wx + m[1, 1] * wy + m[1, 2] * wz,
        m[2, 0] / fx,
        m[2, 1] * dy + m[2, 2] - m[2, 0] * cx / fx,
        m[2, 3] + m[2, 0] * wx + m[2, 1] * wy + m[2, 2] * wz - offset[1],
    )


@compiled(fastmath=True)
def clear(shadow: Any, coarse: Any, aim: Any, first: Any, inverse_first: Any, last: Any, inverse_last: Any) -> Any:
    """Return whether nothing can cast a shadow on the pixels between two of a row on one triangle.

    They lie on a line in the map, and so between the two in depth: the coarse copy tells.
    """
    rows, columns = shadow.shape
    z, w = 1.0 / inverse_first, 1.0 / inverse_last
    x0, x1 = (aim[0] * first + aim[1]) * z + aim[2], (aim[0] * last + aim[1]) * w + aim[2]
    y0, y1 = (aim[3] * first + aim[4]) * z + aim[5], (aim[3] * last + aim[4]) * w + aim[5]
    if not (min(x0, x1) >= 0.0 and min(y0, y1) >= 0.0 and max(x0, x1) < columns - 1 and max(y0, y1) < rows - 1):
        return False
    d0, d1 = (aim[6] * first + aim[7]) * z + aim[8], (aim[6] * last + aim[7]) * w + aim[8]
    deepest = max(d0, d1)
    left, right = int(min(x0, x1)) >> BLOCK_BITS, int(max(x0, x1)) >> BLOCK_BITS
    top, bottom = int(min(y0, y1)) >> BLOCK_BITS, int(max(y0, y1)) >> BLOCK_BITS
    if (right - left + 1) * (bottom - top + 1) > _MAX_BLOCKS:
        return False
    for block_row in range(top, bottom + 1):
        for block in range(left, right + 1):
            if deepest > coarse[block_row, block]:
                return False
    return True


@compiled(fastmath=True, inline=True)
def sun_visibility(shadow: Any, aim: Any, x: Any, inverse: Any) -> Any:
    """Return the visible fraction of the sun at the surface point of a pixel."""
    z = 1.0 / inverse
    return visibility(
        shadow, (aim[0] * x + aim[1]) * z + aim[2], (aim[3] * x + aim[4]) * z + aim[5],
        (aim[6] * x + aim[7]) * z + aim[8],
    )  # fmt: skip


@compiled(fastmath=True, inline=True)
def visibility(shadow: Any, x: Any, y: Any, depth: Any) -> Any:
    """Return the visible fraction of the sun at a point: four comparisons, weighted bilinearly."""
    rows, columns = shadow.shape
    if not (x >= 0.0 and y >= 0.0 and x < columns - 1 and y < rows - 1):
        return np.float32(1.0)
    # Unsigned, so that no index can mean a place from the end.
    i, j = np.uint32(np.int32(x)), np.uint32(np.int32(y))
    d = np.float32(depth)
    one, none = np.float32(1.0), np.float32(0.0)
    a = one if shadow[j, i] >= d else none
    b = one if shadow[j, i + np.uint32(1)] >= d else none
    c = one if shadow[j + np.uint32(1), i] >= d else none
    e = one if shadow[j + np.uint32(1), i + np.uint32(1)] >= d else none
    s, t = np.float32(x) - np.float32(i), np.float32(y) - np.float32(j)
    upper, lower = a + s * (b - a), c + s * (e - c)
    return upper + t * (lower - upper)


@compiled
def coarsen(shadow: Any, coarse: Any, box: Any) -> None:
    """Update the coarse copy of a shadow map where rows and columns of `box` changed.

    A block holds the nearest depth of its pixels and of the next row and column, which `visibility` looks at.
    """
    rows, columns = shadow.shape
    size = 1 << BLOCK_BITS
    for block_row in range(max(0, box[0] - 1) >> BLOCK_BITS, (min(rows - 1, box[1]) >> BLOCK_BITS) + 1):
        for block in range(max(0, box[2] - 1) >> BLOCK_BITS, (min(columns - 1, box[3]) >> BLOCK_BITS) + 1):
            nearest = np.float32(np.inf)
            for row in range(block_row * size, min(rows, block_row * size + size + 1)):
                for column in range(block * size, min(columns, block * size + size + 1)):
                    nearest = min(nearest, shadow[row, column])
            coarse[block_row, block] = nearest
