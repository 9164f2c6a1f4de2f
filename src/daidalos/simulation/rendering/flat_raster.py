"""Rasterization for parallel lights: the compiled loops of shadow maps.

As in `raster`, with every ray parallel: a triangle's edges and its depth are linear in the pixel's place.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from daidalos.common.kernels import compiled
from daidalos.simulation.rendering.raster import cut, rows_of, transform_vertices


@compiled
def draw_flat(
    wanted: Any,
    placed: Any,
    face_ranges: Any,
    vertex_ranges: Any,
    two_sided: Any,
    vertices: Any,
    faces: Any,
    planes: Any,
    transformed: Any,
    depths: Any,
    box: Any,
) -> None:
    """Draw depth along a parallel light, keeping the nearest.

    Parameters
    ----------
    wanted : array (p,) of bool
        Which parts to draw.
    placed : array (p, 3, 4)
        From each part to the map: x and y in pixels, z along the light [m].
    transformed : array (v, 3)
        Scratch: vertices in the map.
    depths : array (rows, columns) of float32
        Along the light; begins with infinity.
    box : array (4,) of int
        First and last row and column that were drawn to; widened.
    Others as in `raster.draw`.
    """
    rows, columns = depths.shape
    for part in range(len(wanted)):
        if not wanted[part]:
            continue
        pose = placed[part]
        transform_vertices(vertex_ranges[part, 0], vertex_ranges[part, 1], pose, vertices, transformed)
        # The light's direction in the part's frame: back faces of a closed shape are hidden.
        lx = pose[0, 1] * pose[1, 2] - pose[0, 2] * pose[1, 1]
        ly = pose[0, 2] * pose[1, 0] - pose[0, 0] * pose[1, 2]
        lz = pose[0, 0] * pose[1, 1] - pose[0, 1] * pose[1, 0]
        both = two_sided[part]
        for face in range(face_ranges[part, 0], face_ranges[part, 1]):
            if not both and planes[face, 0] * lx + planes[face, 1] * ly + planes[face, 2] * lz >= 0.0:
                continue
            i, j, k = faces[face, 0], faces[face, 1], faces[face, 2]
            x0, x1, x2 = transformed[i, 0], transformed[j, 0], transformed[k, 0]
            y0, y1, y2 = transformed[i, 1], transformed[j, 1], transformed[k, 1]
            first_column = max(0.0, np.ceil(min(x0, x1, x2)))
            last_column = min(columns - 1.0, np.floor(max(x0, x1, x2)))
            first_row = max(0.0, np.ceil(min(y0, y1, y2)))
            last_row = min(rows - 1.0, np.floor(max(y0, y1, y2)))
            if first_row > last_row or first_column > last_column:
                continue
            # The same as in `raster.draw` with every vertex at the depth 1.
            a0, b0, c0 = y1 - y2, x2 - x1, x1 * y2 - y1 * x2
            a1, b1, c1 = y2 - y0, x0 - x2, x2 * y0 - y2 * x0
            a2, b2, c2 = y0 - y1, x1 - x0, x0 * y1 - y0 * x1
            det = c0 + c1 + c2
            if det == 0.0 or (det > 0.0 and not both):
                continue
            box[0], box[1] = min(box[0], int(first_row)), max(box[1], int(last_row))
            box[2], box[3] = min(box[2], int(first_column)), max(box[3], int(last_column))
            z0, z1, z2 = transformed[i, 2], transformed[j, 2], transformed[k, 2]
            slope_x = (a0 * z0 + a1 * z1 + a2 * z2) / det
            slope_y = (b0 * z0 + b1 * z1 + b2 * z2) / det
            offset = (c0 * z0 + c1 * z1 + c2 * z2) / det
            turn = -1.0 if det < 0 else 1.0
            fill_flat(
                turn * a0, turn * b0, turn * c0, turn * a1, turn * b1, turn * c1, turn * a2, turn * b2, turn * c2,
                slope_x, slope_y, offset, first_row, last_row + 1.0, first_column, last_column + 1.0, depths,
            )  # fmt: skip


@compiled(fastmath=True, inline=True)
def fill_flat(
    a0: Any,
    b0: Any,
    c0: Any,
    a1: Any,
    b1: Any,
    c1: Any,
    a2: Any,
    b2: Any,
    c2: Any,
    slope_x: Any,
    slope_y: Any,
    offset: Any,
    first_row: Any,
    end_row: Any,
    first_column: Any,
    end_column: Any,
    depths: Any,
) -> None:
    """Write the rows of a triangle where it is nearer to the light than the buffer."""
    p0, q0, s0, t0 = cut(a0, b0, c0)
    p1, q1, s1, t1 = cut(a1, b1, c1)
    p2, q2, s2, t2 = cut(a2, b2, c2)
    first_row, end_row = rows_of(a0, b0, c0, first_row, end_row)
    first_row, end_row = rows_of(a1, b1, c1, first_row, end_row)
    first_row, end_row = rows_of(a2, b2, c2, first_row, end_row)
    change = np.float32(slope_x)
    for row in range(int(first_row), int(end_row)):
        begin = np.ceil(max(first_column, p0 * row + q0, p1 * row + q1, p2 * row + q2))
        end = np.ceil(min(end_column, s0 * row + t0, s1 * row + t1, s2 * row + t2))
        if begin >= end:
            continue
        start = max(int(begin), 0)
        value = np.float32(slope_y * row + offset + slope_x * start)
        for step in range(int(end) - start):
            here = value + change * np.float32(step)
            if here < depths[row, start + step]:
                depths[row, start + step] = here
