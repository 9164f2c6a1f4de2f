"""Rasterization: the compiled loops that find the triangle and the depth of each pixel.

Triangles are scan-converted in homogeneous coordinates, so that none needs to be clipped (Olano and Greer,
"Triangle scan conversion using 2D homogeneous coordinates", 1997). With vertices v0, v1, v2 in the camera's
frame and the ray d of a pixel, e0 = d . (v1 x v2) and its like are linear in the pixel's place, positive
inside, and (e0 + e1 + e2) / det is the inverse of the depth, linear as well.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from daidalos.common.kernels import compiled

NOTHING = -1
"""In a buffer of triangles: the background."""

PROJECTED = 5
"""Numbers kept for each vertex: its place in the camera's frame, and its pixel."""

EDGES = 9
"""Numbers kept for each drawn triangle: slope in x, slope in y and offset of the three e over det."""

_MARGIN = 1e-6
"""Margin of the box around a triangle [pixels], so that its edges decide and not the rounding of its corners."""

_SHORT = 8
"""Runs of fewer pixels than this are written one by one."""


@compiled
def place_parts(part_body: Any, part_pose: Any, body_position: Any, body_rotation: Any, view: Any, placed: Any) -> None:
    """Compose the poses of the parts in the camera frame from their bodies' poses.

    Parameters
    ----------
    part_body : array (p,) of int
    part_pose : array (p, 3, 4)
        Of parts in their bodies.
    body_position : array (b, 3)
    body_rotation : array (b, 9)
        In the world.
    view : array (3, 4)
        From the world to the camera.
    placed : array (p, 3, 4)
        The result.
    """
    for part in range(len(part_body)):
        body = part_body[part]
        for row in range(3):
            # The row of the body's pose in the camera.
            r0 = r1 = r2 = 0.0
            t = view[row, 3]
            for k in range(3):
                v = view[row, k]
                r0 += v * body_rotation[body, 3 * k]
                r1 += v * body_rotation[body, 3 * k + 1]
                r2 += v * body_rotation[body, 3 * k + 2]
                t += v * body_position[body, k]
            for column in range(4):
                placed[part, row, column] = (
                    r0 * part_pose[part, 0, column] + r1 * part_pose[part, 1, column] + r2 * part_pose[part, 2, column]
                )
            placed[part, row, 3] += t


@compiled
def transform_vertices(first: Any, last: Any, pose: Any, vertices: Any, transformed: Any) -> None:
    """Transform a range of points (n, 3) by a pose (3, 4) into the first three columns of another array."""
    a, b, c, d = pose[0, 0], pose[0, 1], pose[0, 2], pose[0, 3]
    e, f, g, h = pose[1, 0], pose[1, 1], pose[1, 2], pose[1, 3]
    i, j, k, m = pose[2, 0], pose[2, 1], pose[2, 2], pose[2, 3]
    for n in range(first, last):
        x, y, z = vertices[n, 0], vertices[n, 1], vertices[n, 2]
        transformed[n, 0] = a * x + b * y + c * z + d
        transformed[n, 1] = e * x + f * y + g * z + h
        transformed[n, 2] = i * x + j * y + k * z + m


@compiled
def project_vertices(first: Any, last: Any, pose: Any, lens: Any, vertices: Any, projected: Any) -> None:
    """Transform a range of points (n, 3) by a pose (3, 4) and project them: x, y, z and pixels (n, 5).

    The pixels of what lies behind the eye have no meaning.
    """
    transform_vertices(first, last, pose, vertices, projected)
    fx, fy, cx, cy = lens[0], lens[1], lens[2], lens[3]
    for n in range(first, last):
        nearness = 1.0 / projected[n, 2]
        projected[n, 3] = fx * projected[n, 0] * nearness + cx
        projected[n, 4] = fy * projected[n, 1] * nearness + cy


@compiled
def draw(
    wanted: Any,
    placed: Any,
    spheres: Any,
    face_ranges: Any,
    face_rows: Any,
    vertex_ranges: Any,
    two_sided: Any,
    vertices: Any,
    faces: Any,
    planes: Any,
    lens: Any,
    near: Any,
    far: Any,
    projected: Any,
    edges: Any,
    flipped: Any,
    inverse: Any,
    triangles: Any,
) -> None:
    """Draw parts into buffers of inverse depths and triangles, keeping the nearest.

    Parameters
    ----------
    wanted : array (p,) of bool
        Which parts to draw.
    placed : array (p, 3, 4)
        Poses of the parts in the camera's optical frame (z ahead, x right, y down).
    spheres : array (p, 4)
        Centre, in the part's frame, and radius of a ball around each part.
    face_ranges : array (p, 2) of int
        First triangle and the one behind the last, in numbers that count those of all parts.
    face_rows : array (p,) of int
        Row in `faces` of each part's first triangle; parts of one shape have the same.
    vertex_ranges : array (p, 2) of int
        First row in `vertices` and the one behind the last.
    two_sided : array (p,) of bool
        Whether triangles are seen from behind too.
    vertices : array (v, 3)
    faces : array (f, 3) of int
    planes : array (f, 4)
        Normal of each triangle, of any length, and its scalar product with the triangle's points, in the part's frame.
    lens : array (4,)
        Focal lengths and principal point [pixels].
    near, far : float
        What is nearer or further is not drawn [m].
    projected : array (v, 5)
        Scratch: vertices in the camera's frame and in pixels.
    edges : array (t, 9)
        Written for every drawn triangle, see `EDGES`.
    flipped : array (t,) of bool
        Written for every drawn triangle: whether it is seen from behind.
    inverse : array (rows, columns) of float32
        Inverse depths [1/m]; begins with 1 / far.
    triangles : array (rows, columns) of int32
        The number of the triangle that is seen.
    """
    rows, columns = inverse.shape
    fx, fy, cx, cy = lens[0], lens[1], lens[2], lens[3]
    left, right = -cx / fx, (columns - 1 - cx) / fx
    top, bottom = -cy / fy, (rows - 1 - cy) / fy
    for part in range(len(wanted)):
        pose = placed[part]
        if not wanted[part] or outside(pose, spheres[part], left, right, top, bottom, near, far):
            continue
        project_vertices(vertex_ranges[part, 0], vertex_ranges[part, 1], pose, lens, vertices, projected)
        # The camera position in the part's frame, to find the triangles that face it.
        ex = -(pose[0, 0] * pose[0, 3] + pose[1, 0] * pose[1, 3] + pose[2, 0] * pose[2, 3])
        ey = -(pose[0, 1] * pose[0, 3] + pose[1, 1] * pose[1, 3] + pose[2, 1] * pose[2, 3])
        ez = -(pose[0, 2] * pose[0, 3] + pose[1, 2] * pose[1, 3] + pose[2, 2] * pose[2, 3])
        both = two_sided[part]
        shift = face_rows[part] - face_ranges[part, 0]
        for face in range(face_ranges[part, 0], face_ranges[part, 1]):
            at = face + shift
            if not both and planes[at, 0] * ex + planes[at, 1] * ey + planes[at, 2] * ez <= planes[at, 3]:
                continue
            i, j, k = faces[at, 0], faces[at, 1], faces[at, 2]
            z0, z1, z2 = projected[i, 2], projected[j, 2], projected[k, 2]
            if z0 < near and z1 < near and z2 < near:
                continue
            crosses = z0 < near or z1 < near or z2 < near
            first_row, last_row, first_column, last_column = 0.0, rows - 1.0, 0.0, columns - 1.0
            if not crosses:
                u0, u1, u2 = projected[i, 3], projected[j, 3], projected[k, 3]
                v0, v1, v2 = projected[i, 4], projected[j, 4], projected[k, 4]
                first_column = max(first_column, np.ceil(min(u0, u1, u2) - _MARGIN))
                last_column = min(last_column, np.floor(max(u0, u1, u2) + _MARGIN))
                first_row = max(first_row, np.ceil(min(v0, v1, v2) - _MARGIN))
                last_row = min(last_row, np.floor(max(v0, v1, v2) + _MARGIN))
                if first_row > last_row or first_column > last_column:
                    continue
            draw_face(
                face, i, j, k, projected, first_row, last_row + 1.0, first_column, last_column + 1.0,
                np.float32(1.0 / near if crosses else np.inf), both, lens, edges, flipped, inverse, triangles,
            )  # fmt: skip


@compiled(fastmath=True, inline=True)
def draw_face(
    face: Any,
    i: Any,
    j: Any,
    k: Any,
    projected: Any,
    first_row: Any,
    end_row: Any,
    first_column: Any,
    end_column: Any,
    nearest: Any,
    two_sided: Any,
    lens: Any,
    edges: Any,
    flipped: Any,
    inverse: Any,
    triangles: Any,
) -> None:
    """Draw one triangle into a box of pixels where its inverse depth is at most `nearest`."""
    fx, fy, cx, cy = lens[0], lens[1], lens[2], lens[3]
    x0, y0, z0 = projected[i, 0], projected[i, 1], projected[i, 2]
    x1, y1, z1 = projected[j, 0], projected[j, 1], projected[j, 2]
    x2, y2, z2 = projected[k, 0], projected[k, 1], projected[k, 2]
    # Normals of the planes through the eye and each edge.
    a0, b0, c0 = y1 * z2 - z1 * y2, z1 * x2 - x1 * z2, x1 * y2 - y1 * x2
    det = x0 * a0 + y0 * b0 + z0 * c0
    if det == 0.0 or (det > 0.0 and not two_sided):
        return
    a1, b1, c1 = y2 * z0 - z2 * y0, z2 * x0 - x2 * z0, x2 * y0 - y2 * x0
    a2, b2, c2 = y0 * z1 - z0 * y1, z0 * x1 - x0 * z1, x0 * y1 - y0 * x1
    # In pixels; turned so that the inside is positive from either side.
    turn = -1.0 if det < 0 else 1.0
    across, down = turn / fx, turn / fy
    a0, b0, c0 = across * a0, down * b0, turn * c0
    a1, b1, c1 = across * a1, down * b1, turn * c1
    a2, b2, c2 = across * a2, down * b2, turn * c2
    c0 -= a0 * cx + b0 * cy
    c1 -= a1 * cx + b1 * cy
    c2 -= a2 * cx + b2 * cy
    scale = 1.0 / abs(det)
    slope_x, slope_y, offset = (a0 + a1 + a2) * scale, (b0 + b1 + b2) * scale, (c0 + c1 + c2) * scale
    # Where each edge cuts a row is p * row + q: before the first pixels of the triangle, or behind the last.
    p0, q0, s0, t0 = cut(a0, b0, c0)
    p1, q1, s1, t1 = cut(a1, b1, c1)
    p2, q2, s2, t2 = cut(a2, b2, c2)
    first_row, end_row = rows_of(a0, b0, c0, first_row, end_row)
    first_row, end_row = rows_of(a1, b1, c1, first_row, end_row)
    first_row, end_row = rows_of(a2, b2, c2, first_row, end_row)
    small = end_column - first_column <= _SHORT
    drawn = False
    for row in range(int(first_row), int(end_row)):
        begin = max(first_column, p0 * row + q0, p1 * row + q1, p2 * row + q2)
        end = min(end_column, s0 * row + t0, s1 * row + t1, s2 * row + t2)
        value = slope_y * row + offset
        if small:
            # To ask each of a few pixels is quicker than to guess wrong how many there are.
            for column in range(int(first_column), int(end_column)):
                here = np.float32(value + slope_x * column)
                inside = (begin <= column) & (column < end)
                if inside & (inverse[row, column] < here) & (here <= nearest):
                    inverse[row, column] = here
                    triangles[row, column] = face
                    drawn = True
        elif np.ceil(begin) < end:
            start = max(int(np.ceil(begin)), 0)
            value += slope_x * start
            fill(
                inverse, triangles, row, start, int(np.ceil(end)), np.float32(value), np.float32(slope_x), face, nearest
            )
            drawn = True
    if drawn:
        edges[face, 0], edges[face, 1], edges[face, 2] = a0 * scale, b0 * scale, c0 * scale
        edges[face, 3], edges[face, 4], edges[face, 5] = a1 * scale, b1 * scale, c1 * scale
        edges[face, 6], edges[face, 7], edges[face, 8] = a2 * scale, b2 * scale, c2 * scale
        flipped[face] = det > 0.0


@compiled(fastmath=True, inline=True)
def fill(
    inverse: Any, triangles: Any, row: Any, start: Any, stop: Any, value: Any, change: Any, face: Any, nearest: Any
) -> None:
    """Write a triangle into a run of pixels where it is nearer than the buffer."""
    if stop - start < _SHORT:
        for column in range(start, stop):
            here = value + change * np.float32(column - start)
            if inverse[row, column] < here <= nearest:
                inverse[row, column] = here
                triangles[row, column] = face
        return
    # From an offset that is known not to be negative the compiler makes vector instructions.
    for offset in range(stop - start):
        here = value + change * np.float32(offset)
        if inverse[row, start + offset] < here <= nearest:
            inverse[row, start + offset] = here
            triangles[row, start + offset] = face


@compiled(fastmath=True, inline=True)
def cut(slope_x: Any, slope_y: Any, offset: Any) -> Any:
    """Return the range where slope_x * x + slope_y * row + offset is positive, as two lines over rows.

    Each line is p * row + q; minus and plus infinity where there is no such place. What lies exactly on an edge belongs
    to the triangle on its right or, for a level edge, below it: triangles that share an edge neither overlap nor leave
    a gap, since both compute the same line.
    """
    scale = -1.0 / slope_x
    if slope_x > 0.0:
        return scale * slope_y, scale * offset, 0.0, np.inf
    if slope_x < 0.0:
        return 0.0, -np.inf, scale * slope_y, scale * offset
    return 0.0, -np.inf, 0.0, np.inf


@compiled(fastmath=True, inline=True)
def rows_of(slope_x: Any, slope_y: Any, offset: Any, first: Any, end: Any) -> Any:
    """Narrow a range of rows at a horizontal edge; other edges leave it unchanged."""
    if slope_x == 0.0:
        if slope_y > 0.0:
            first = max(first, np.ceil(min(-offset / slope_y, end)))
        elif slope_y < 0.0:
            end = min(end, np.ceil(max(-offset / slope_y, first)))
        elif offset < 0.0:
            end = first
    return first, end


@compiled
def outside(pose: Any, sphere: Any, left: Any, right: Any, top: Any, bottom: Any, near: Any, far: Any) -> Any:
    """Return whether a sphere lies outside the view frustum."""
    x = pose[0, 0] * sphere[0] + pose[0, 1] * sphere[1] + pose[0, 2] * sphere[2] + pose[0, 3]
    y = pose[1, 0] * sphere[0] + pose[1, 1] * sphere[1] + pose[1, 2] * sphere[2] + pose[1, 3]
    z = pose[2, 0] * sphere[0] + pose[2, 1] * sphere[1] + pose[2, 2] * sphere[2] + pose[2, 3]
    radius = sphere[3]
    if z + radius < near or z - radius > far:
        return True
    return (
        x - left * z < -radius * math.hypot(1.0, left)
        or right * z - x < -radius * math.hypot(1.0, right)
        or y - top * z < -radius * math.hypot(1.0, top)
        or bottom * z - y < -radius * math.hypot(1.0, bottom)
    )
