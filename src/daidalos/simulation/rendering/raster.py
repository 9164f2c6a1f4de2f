"""Which triangle each pixel sees, and how far it is: the compiled loops of the rasteriser.

Triangles are scan-converted in homogeneous coordinates, so that none needs to be clipped (Olano and Greer,
"Triangle scan conversion using 2D homogeneous coordinates", 1997). With vertices v0, v1, v2 in the camera's
frame and the ray d of a pixel, e0 = d . (v1 x v2) and its like are linear in the pixel's place, positive
inside, and (e0 + e1 + e2) / det is the inverse of the depth, linear as well.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from daidalos.simulation.rendering.compilation import compiled

NOTHING = -1
"""In a buffer of triangles: the background."""

EDGES = 9
"""Numbers kept for each drawn triangle: slope in x, slope in y and offset of the three e over det."""


@compiled
def place_parts(part_body: Any, part_pose: Any, body_position: Any, body_rotation: Any, view: Any, placed: Any) -> None:
    """Compose poses: from each part to the camera, by way of its body.

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
    """Transform a range of points (n, 3) by a pose (3, 4)."""
    a, b, c, d = pose[0, 0], pose[0, 1], pose[0, 2], pose[0, 3]
    e, f, g, h = pose[1, 0], pose[1, 1], pose[1, 2], pose[1, 3]
    i, j, k, m = pose[2, 0], pose[2, 1], pose[2, 2], pose[2, 3]
    for n in range(first, last):
        x, y, z = vertices[n, 0], vertices[n, 1], vertices[n, 2]
        transformed[n, 0] = a * x + b * y + c * z + d
        transformed[n, 1] = e * x + f * y + g * z + h
        transformed[n, 2] = i * x + j * y + k * z + m


@compiled
def draw(
    wanted: Any,
    placed: Any,
    spheres: Any,
    face_ranges: Any,
    vertex_ranges: Any,
    two_sided: Any,
    vertices: Any,
    faces: Any,
    lens: Any,
    near: Any,
    far: Any,
    transformed: Any,
    edges: Any,
    flipped: Any,
    inverse: Any,
    triangles: Any,
) -> None:
    """Draw parts into a buffer of inverse depths and one of triangles, keeping what is nearer.

    Parameters
    ----------
    wanted : array (p,) of bool
        Which parts to draw.
    placed : array (p, 3, 4)
        Poses of the parts in the camera's optical frame (z ahead, x right, y down).
    spheres : array (p, 4)
        Centre, in the part's frame, and radius of a ball around each part.
    face_ranges, vertex_ranges : array (p, 2) of int
        First and behind the last row in `faces` and `vertices`.
    two_sided : array (p,) of bool
        Whether triangles are seen from behind too.
    vertices : array (v, 3)
    faces : array (f, 3) of int
    lens : array (4,)
        Focal lengths and principal point [pixels].
    near, far : float
        What is nearer or further is not drawn [m].
    transformed : array (v, 3)
        Scratch: vertices in the camera's frame.
    edges : array (f, 9)
        Written for every drawn triangle, see `EDGES`.
    flipped : array (f,) of bool
        Written for every drawn triangle: whether it is seen from behind.
    inverse : array (rows, columns) of float32
        Inverse depths [1/m]; begins with 1 / far.
    triangles : array (rows, columns) of int32
        The row in `faces` that is seen.
    """
    rows, columns = inverse.shape
    fx, fy, cx, cy = lens[0], lens[1], lens[2], lens[3]
    left, right = -cx / fx, (columns - 1 - cx) / fx
    top, bottom = -cy / fy, (rows - 1 - cy) / fy
    for part in range(len(wanted)):
        if not wanted[part] or outside(placed[part], spheres[part], left, right, top, bottom, near, far):
            continue
        transform_vertices(vertex_ranges[part, 0], vertex_ranges[part, 1], placed[part], vertices, transformed)
        for face in range(face_ranges[part, 0], face_ranges[part, 1]):
            i, j, k = faces[face, 0], faces[face, 1], faces[face, 2]
            x0, y0, z0 = transformed[i, 0], transformed[i, 1], transformed[i, 2]
            x1, y1, z1 = transformed[j, 0], transformed[j, 1], transformed[j, 2]
            x2, y2, z2 = transformed[k, 0], transformed[k, 1], transformed[k, 2]
            if z0 < near and z1 < near and z2 < near:
                continue
            # Normals of the planes through the eye and each edge.
            a0, b0, c0 = y1 * z2 - z1 * y2, z1 * x2 - x1 * z2, x1 * y2 - y1 * x2
            det = x0 * a0 + y0 * b0 + z0 * c0
            if det == 0.0 or (det > 0.0 and not two_sided[part]):
                continue
            a1, b1, c1 = y2 * z0 - z2 * y0, z2 * x0 - x2 * z0, x2 * y0 - y2 * x0
            a2, b2, c2 = y0 * z1 - z0 * y1, z0 * x1 - x0 * z1, x0 * y1 - y0 * x1
            crosses = z0 < near or z1 < near or z2 < near
            first_row, last_row, first_column, last_column = 0, rows - 1, 0, columns - 1
            if not crosses:
                u0, u1, u2 = fx * x0 / z0 + cx, fx * x1 / z1 + cx, fx * x2 / z2 + cx
                v0, v1, v2 = fy * y0 / z0 + cy, fy * y1 / z1 + cy, fy * y2 / z2 + cy
                lowest, highest = min(u0, u1, u2), max(u0, u1, u2)
                if highest < 0 or lowest > columns - 1:
                    continue
                first_column, last_column = max(0, math.ceil(lowest)), min(columns - 1, math.floor(highest))
                lowest, highest = min(v0, v1, v2), max(v0, v1, v2)
                if highest < 0 or lowest > rows - 1:
                    continue
                first_row, last_row = max(0, math.ceil(lowest)), min(rows - 1, math.floor(highest))
                if first_row > last_row or first_column > last_column:
                    continue
            # In pixels; turned so that the inside is positive from either side.
            turn = -1.0 if det < 0 else 1.0
            a0, b0, c0 = turn * a0 / fx, turn * b0 / fy, turn * c0
            a1, b1, c1 = turn * a1 / fx, turn * b1 / fy, turn * c1
            a2, b2, c2 = turn * a2 / fx, turn * b2 / fy, turn * c2
            c0 -= a0 * cx + b0 * cy
            c1 -= a1 * cx + b1 * cy
            c2 -= a2 * cx + b2 * cy
            scale = 1.0 / abs(det)
            slope = (a0 + a1 + a2) * scale
            drawn = False
            for row in range(first_row, last_row + 1):
                r0, r1, r2 = b0 * row + c0, b1 * row + c1, b2 * row + c2
                begin, end = float(first_column), float(last_column + 1)
                begin, end = narrow(a0, b0, r0, begin, end)
                begin, end = narrow(a1, b1, r1, begin, end)
                begin, end = narrow(a2, b2, r2, begin, end)
                if begin >= end:
                    continue
                start, stop = int(begin), int(end)
                value = np.float32((r0 + r1 + r2) * scale + slope * start)
                change = np.float32(slope)
                line, seen = inverse[row], triangles[row]
                drawn = True
                if crosses:
                    nearest = np.float32(1.0 / near)
                    for column in range(start, stop):
                        here = value + change * np.float32(column - start)
                        if line[column] < here <= nearest:
                            line[column] = here
                            seen[column] = face
                else:
                    for column in range(start, stop):
                        here = value + change * np.float32(column - start)
                        if here > line[column]:
                            line[column] = here
                            seen[column] = face
            if drawn:
                edges[face, 0], edges[face, 1], edges[face, 2] = a0 * scale, b0 * scale, c0 * scale
                edges[face, 3], edges[face, 4], edges[face, 5] = a1 * scale, b1 * scale, c1 * scale
                edges[face, 6], edges[face, 7], edges[face, 8] = a2 * scale, b2 * scale, c2 * scale
                flipped[face] = det > 0.0


@compiled
def draw_flat(
    wanted: Any,
    placed: Any,
    face_ranges: Any,
    vertex_ranges: Any,
    two_sided: Any,
    vertices: Any,
    faces: Any,
    transformed: Any,
    depths: Any,
    box: Any,
) -> None:
    """Draw the depths that a parallel light sees, keeping the nearest.

    Parameters
    ----------
    placed : array (p, 3, 4)
        From each part to the map: x and y in pixels, z along the light [m].
    depths : array (rows, columns) of float32
        Along the light; begins with infinity.
    box : array (4,) of int
        First and last row and column that were drawn to; widened.
    Others as in `draw`.
    """
    rows, columns = depths.shape
    for part in range(len(wanted)):
        if not wanted[part]:
            continue
        transform_vertices(vertex_ranges[part, 0], vertex_ranges[part, 1], placed[part], vertices, transformed)
        for face in range(face_ranges[part, 0], face_ranges[part, 1]):
            i, j, k = faces[face, 0], faces[face, 1], faces[face, 2]
            x0, y0, z0 = transformed[i, 0], transformed[i, 1], transformed[i, 2]
            x1, y1, z1 = transformed[j, 0], transformed[j, 1], transformed[j, 2]
            x2, y2, z2 = transformed[k, 0], transformed[k, 1], transformed[k, 2]
            lowest, highest = min(x0, x1, x2), max(x0, x1, x2)
            if highest < 0 or lowest > columns - 1:
                continue
            first_column, last_column = max(0, math.ceil(lowest)), min(columns - 1, math.floor(highest))
            lowest, highest = min(y0, y1, y2), max(y0, y1, y2)
            if highest < 0 or lowest > rows - 1:
                continue
            first_row, last_row = max(0, math.ceil(lowest)), min(rows - 1, math.floor(highest))
            if first_row > last_row or first_column > last_column:
                continue
            # The same as in `draw` with every vertex at the depth 1.
            a0, b0, c0 = y1 - y2, x2 - x1, x1 * y2 - y1 * x2
            a1, b1, c1 = y2 - y0, x0 - x2, x2 * y0 - y2 * x0
            a2, b2, c2 = y0 - y1, x1 - x0, x0 * y1 - y0 * x1
            det = c0 + c1 + c2
            # What a closed shape turns away from the light lies behind what it turns towards it.
            if det == 0.0 or (det > 0.0 and not two_sided[part]):
                continue
            slope_x = (a0 * z0 + a1 * z1 + a2 * z2) / det
            slope_y = (b0 * z0 + b1 * z1 + b2 * z2) / det
            offset = (c0 * z0 + c1 * z1 + c2 * z2) / det
            turn = -1.0 if det < 0 else 1.0
            a0, b0, c0 = turn * a0, turn * b0, turn * c0
            a1, b1, c1 = turn * a1, turn * b1, turn * c1
            a2, b2, c2 = turn * a2, turn * b2, turn * c2
            box[0], box[1] = min(box[0], first_row), max(box[1], last_row)
            box[2], box[3] = min(box[2], first_column), max(box[3], last_column)
            change = np.float32(slope_x)
            for row in range(first_row, last_row + 1):
                begin, end = float(first_column), float(last_column + 1)
                begin, end = narrow(a0, b0, b0 * row + c0, begin, end)
                begin, end = narrow(a1, b1, b1 * row + c1, begin, end)
                begin, end = narrow(a2, b2, b2 * row + c2, begin, end)
                if begin >= end:
                    continue
                start, stop = int(begin), int(end)
                value = np.float32(slope_y * row + offset + slope_x * start)
                line = depths[row]
                for column in range(start, stop):
                    here = value + change * np.float32(column - start)
                    if here < line[column]:
                        line[column] = here


@compiled
def outside(pose: Any, sphere: Any, left: Any, right: Any, top: Any, bottom: Any, near: Any, far: Any) -> Any:
    """Tell whether a ball lies outside the view's frustum."""
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


@compiled
def narrow(slope_x: Any, slope_y: Any, offset: Any, begin: Any, end: Any) -> Any:
    """Narrow a span of pixels to where slope_x * x + offset is positive.

    What lies exactly on an edge belongs to the triangle on its right or, for a level edge, below it: triangles
    that share an edge neither overlap nor leave a gap.
    """
    if slope_x > 0.0:
        crossing = -offset / slope_x
        if crossing > begin:
            begin = math.ceil(min(crossing, end))
    elif slope_x < 0.0:
        crossing = -offset / slope_x
        if crossing < end:
            end = math.ceil(max(crossing, begin))
    elif offset < 0.0 or (offset == 0.0 and slope_y < 0.0):
        end = begin
    return begin, end
