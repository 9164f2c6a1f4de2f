"""What colour each pixel gets: light, shadow and textures, in one compiled loop over runs of pixels.

Everything that a run of pixels in one triangle needs is worked out once for the run; within it depth,
light and texture coordinates are linear or linear over depth.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from daidalos.simulation.rendering.compilation import compiled, compiled_in_place, compiled_loosely

LAMP = 18
"""Numbers that describe a lamp: kind, place, direction, colour, range, fading (3), cosines of the cone (2), falloff,
whether it shines."""

POINT, SPOT, DIRECTIONAL = 0.0, 1.0, 2.0

_RUN = 32
_BLOCK = 4
"""Shadow maps have a coarse copy: the nearest depth in blocks of 2**_BLOCK pixels a side."""


@compiled_loosely
def shade(
    triangles: Any,
    inverse: Any,
    edges: Any,
    flipped: Any,
    face_part: Any,
    faces: Any,
    normals: Any,
    uv: Any,
    placed: Any,
    colors: Any,
    emissions: Any,
    alphas: Any,
    texture_of: Any,
    texels: Any,
    texture_levels: Any,
    levels: Any,
    lens: Any,
    background: Any,
    horizon: Any,
    ambient: Any,
    sun: Any,
    sun_color: Any,
    lamps: Any,
    shadow: Any,
    coarse: Any,
    to_shadow: Any,
    offset: Any,
    picture: Any,
    blend: Any,
) -> None:
    """Colour all pixels.

    Parameters
    ----------
    triangles, inverse, edges, flipped
        As `raster.draw` left them.
    face_part : array (f,) of int
        The part that each triangle belongs to.
    faces : array (f, 3) of int
    normals : array (v, 3)
        In the parts' frames.
    uv : array (v, 2)
        Texture coordinates, v upwards.
    placed : array (p, 3, 4)
        Poses of the parts in the camera's optical frame.
    colors, emissions : array (p, 3) of float32
        0..1; colours multiply textures.
    alphas : array (p,) of float32
        For `blend`.
    texture_of : array (p,) of int
        Row of `texture_levels`, -1 for none.
    texels : array (n, 4) of uint8
    texture_levels : array (t, 2) of int
        First row in `levels` and how many there are.
    levels : array (m, 3) of int
        First texel, width and height of each level, each half the size of the one before.
    lens : array (4,)
        Focal lengths and principal point [pixels].
    background : array (2, 3) of float32
        Colour of the sky at the horizon and above.
    horizon : array (3,)
        Up in the camera's frame.
    ambient, sun_color : array (3,) of float32
    sun : array (3,)
        Unit vector towards the parallel light, in the camera's frame.
    lamps : array (l, LAMP)
        Further lights, in the camera's frame.
    shadow : array (rows, columns) of float32
        Depths of what the sun sees; no rows for no shadow.
    coarse : array of float32
        The nearest depth in each block of `shadow`.
    to_shadow : array (3, 4)
        From the camera's frame to pixels of the map and depth.
    offset : array (2,)
        Distance along the normal and along the light within which nothing is in shadow [m].
    picture : array (rows, columns, 3) of uint8
        The result.
    blend : bool
        Leave the background and mix with what `picture` holds by the parts' alphas.
    """
    rows, columns = triangles.shape
    fx, fy, cx, cy = lens[0], lens[1], lens[2], lens[3]
    shadowed = shadow.shape[0] > 0
    aim = np.zeros((3, 3))
    sunny = sun_color[0] + sun_color[1] + sun_color[2] > 0.0
    for row in range(rows):
        line, seen, depths = picture[row], triangles[row], inverse[row]
        dy = (row - cy) / fy
        column = 0
        while column < columns:
            face = seen[column]
            start = column
            column += 1
            while column < columns and seen[column] == face:
                column += 1
            if face < 0:
                if not blend:
                    fill_background(line, start, column, dy, fx, cx, background, horizon)
                continue
            part = face_part[face]
            pose = placed[part]
            turn = -1.0 if flipped[face] else 1.0
            # The sun's direction in the part's frame, so that normals need not be turned.
            sx = turn * (pose[0, 0] * sun[0] + pose[1, 0] * sun[1] + pose[2, 0] * sun[2])
            sy = turn * (pose[0, 1] * sun[0] + pose[1, 1] * sun[1] + pose[2, 1] * sun[2])
            sz = turn * (pose[0, 2] * sun[0] + pose[1, 2] * sun[1] + pose[2, 2] * sun[2])
            i, j, k = faces[face, 0], faces[face, 1], faces[face, 2]
            g0 = max(0.0, normals[i, 0] * sx + normals[i, 1] * sy + normals[i, 2] * sz)
            g1 = max(0.0, normals[j, 0] * sx + normals[j, 1] * sy + normals[j, 2] * sz)
            g2 = max(0.0, normals[k, 0] * sx + normals[k, 1] * sy + normals[k, 2] * sz)
            lit = sunny and g0 + g1 + g2 > 0.0
            red, green, blue = colors[part, 0], colors[part, 1], colors[part, 2]
            # The colour in the shade, and what the full sun adds.
            ar, ag, ab = red * ambient[0], green * ambient[1], blue * ambient[2]
            sr, sg, sb = red * sun_color[0], green * sun_color[1], blue * sun_color[2]
            gr, gg, gb = emissions[part, 0], emissions[part, 1], emissions[part, 2]
            alpha = alphas[part] if blend else np.float32(1.0)
            plain = texture_of[part] < 0 and len(lamps) == 0
            if plain and not lit:
                put(line, start, column, ar + gr, ag + gg, ab + gb, alpha)
                continue
            # Light over depth: linear.
            e = edges[face]
            slope = np.float32(g0 * e[0] + g1 * e[3] + g2 * e[6])
            base = np.float32(g0 * (e[1] * row + e[2]) + g1 * (e[4] * row + e[5]) + g2 * (e[7] * row + e[8]))
            casts = lit and shadowed
            if casts:
                nx = turn * (normals[i, 0] + normals[j, 0] + normals[k, 0]) / 3
                ny = turn * (normals[i, 1] + normals[j, 1] + normals[k, 1]) / 3
                nz = turn * (normals[i, 2] + normals[j, 2] + normals[k, 2]) / 3
                aim_at_shadow(to_shadow, offset, pose, nx, ny, nz, dy, fx, cx, aim)
            for first in range(start, column, _RUN):
                last = min(first + _RUN, column)
                dark = casts and not clear(shadow, coarse, aim, first, depths[first], last - 1, depths[last - 1])
                if not plain:
                    paint_rich(
                        line, depths, first, last, row, face, part, dy, turn, edges, faces, normals, uv, pose, colors,
                        emissions, alpha, texture_of, texels, texture_levels, levels, fx, cx, ambient, sun_color,
                        lamps, slope, base, dark, shadow, coarse, aim,
                    )  # fmt: skip
                elif dark:
                    shine = np.float32(1.0)
                    for x in range(first, last):
                        # Every other pixel is asked, and its neighbour's answer taken.
                        if (x - first) & 1 == 0:
                            shine = sunshine(shadow, coarse, aim, x, depths[x])
                        g = (base + slope * np.float32(x)) / depths[x] * shine
                        put_one(line, x, ar + g * sr + gr, ag + g * sg + gg, ab + g * sb + gb, alpha)
                else:
                    for x in range(first, last):
                        g = (base + slope * np.float32(x)) / depths[x]
                        put_one(line, x, ar + g * sr + gr, ag + g * sg + gg, ab + g * sb + gb, alpha)


@compiled_loosely
def paint_rich(
    line: Any,
    depths: Any,
    first: Any,
    last: Any,
    row: Any,
    face: Any,
    part: Any,
    dy: Any,
    turn: Any,
    edges: Any,
    faces: Any,
    normals: Any,
    uv: Any,
    pose: Any,
    colors: Any,
    emissions: Any,
    alpha: Any,
    texture_of: Any,
    texels: Any,
    texture_levels: Any,
    levels: Any,
    fx: Any,
    cx: Any,
    ambient: Any,
    sun_color: Any,
    lamps: Any,
    slope: Any,
    base: Any,
    dark: Any,
    shadow: Any,
    coarse: Any,
    aim: Any,
) -> None:
    """Colour pixels of one triangle that has a texture, or the light of lamps."""
    e = edges[face]
    a0, a1, a2 = e[0], e[3], e[6]
    r0, r1, r2 = e[1] * row + e[2], e[4] * row + e[5], e[7] * row + e[8]
    i, j, k = faces[face, 0], faces[face, 1], faces[face, 2]
    texture = texture_of[part]
    ua = ur = va = vr = 0.0
    level = 0
    if texture >= 0:
        u0, u1, u2 = uv[i, 0], uv[j, 0], uv[k, 0]
        v0, v1, v2 = uv[i, 1], uv[j, 1], uv[k, 1]
        ua, ur = u0 * a0 + u1 * a1 + u2 * a2, u0 * r0 + u1 * r1 + u2 * r2
        va, vr = v0 * a0 + v1 * a1 + v2 * a2, v0 * r0 + v1 * r1 + v2 * r2
        ub, vb = u0 * e[1] + u1 * e[4] + u2 * e[7], v0 * e[1] + v1 * e[4] + v2 * e[7]
        z = 1.0 / depths[first]
        u, v = (ua * first + ur) * z, (va * first + vr) * z
        # The slopes of inverse depth are the sums of those of the three e.
        za, zb = a0 + a1 + a2, e[1] + e[4] + e[7]
        level = mip_level(levels, texture_levels[texture], (ua - u * za) * z, (va - v * za) * z,
                          (ub - u * zb) * z, (vb - v * zb) * z)  # fmt: skip
    for x in range(first, last):
        z = 1.0 / depths[x]
        g = (base + slope * np.float32(x)) * z
        if dark:
            g *= sunshine(shadow, coarse, aim, x, depths[x])
        red, green, blue = ambient[0] + g * sun_color[0], ambient[1] + g * sun_color[1], ambient[2] + g * sun_color[2]
        if len(lamps) > 0:
            w0, w1, w2 = turn * (a0 * x + r0) * z, turn * (a1 * x + r1) * z, turn * (a2 * x + r2) * z
            nx = w0 * normals[i, 0] + w1 * normals[j, 0] + w2 * normals[k, 0]
            ny = w0 * normals[i, 1] + w1 * normals[j, 1] + w2 * normals[k, 1]
            nz = w0 * normals[i, 2] + w1 * normals[j, 2] + w2 * normals[k, 2]
            cnx = pose[0, 0] * nx + pose[0, 1] * ny + pose[0, 2] * nz
            cny = pose[1, 0] * nx + pose[1, 1] * ny + pose[1, 2] * nz
            cnz = pose[2, 0] * nx + pose[2, 1] * ny + pose[2, 2] * nz
            for lamp in lamps:
                g = lamp_light(lamp, (x - cx) / fx * z, dy * z, z, cnx, cny, cnz)
                red, green, blue = red + g * lamp[7], green + g * lamp[8], blue + g * lamp[9]
        if texture >= 0:
            tr, tg, tb = sample(texels, levels[level], (ua * x + ur) * z, (va * x + vr) * z)
            red, green, blue = red * tr, green * tg, blue * tb
        put_one(line, x, colors[part, 0] * red + emissions[part, 0], colors[part, 1] * green + emissions[part, 1],
                colors[part, 2] * blue + emissions[part, 2], alpha)  # fmt: skip


@compiled_loosely
def aim_at_shadow(
    to_shadow: Any, offset: Any, pose: Any, nx: Any, ny: Any, nz: Any, dy: Any, fx: Any, cx: Any, aim: Any
) -> None:
    """Work out where in the shadow map the pixels of a row are: (aim[:, 0] x + aim[:, 1]) z + aim[:, 2].

    They are looked up a little off the surface, along its normal and towards the light.
    """
    wx = offset[0] * (pose[0, 0] * nx + pose[0, 1] * ny + pose[0, 2] * nz)
    wy = offset[0] * (pose[1, 0] * nx + pose[1, 1] * ny + pose[1, 2] * nz)
    wz = offset[0] * (pose[2, 0] * nx + pose[2, 1] * ny + pose[2, 2] * nz)
    for n in range(3):
        m = to_shadow[n]
        aim[n, 0] = m[0] / fx
        aim[n, 1] = m[1] * dy + m[2] - m[0] * cx / fx
        aim[n, 2] = m[3] + m[0] * wx + m[1] * wy + m[2] * wz
    aim[2, 2] -= offset[1]


@compiled_loosely
def clear(shadow: Any, coarse: Any, aim: Any, first: Any, inverse_first: Any, last: Any, inverse_last: Any) -> Any:
    """Tell whether nothing can shade the pixels between two of a row that see one triangle.

    They lie on a line in the map, and so between the two in depth: the coarse copy tells.
    """
    rows, columns = shadow.shape
    z, w = 1.0 / inverse_first, 1.0 / inverse_last
    x0, x1 = (aim[0, 0] * first + aim[0, 1]) * z + aim[0, 2], (aim[0, 0] * last + aim[0, 1]) * w + aim[0, 2]
    y0, y1 = (aim[1, 0] * first + aim[1, 1]) * z + aim[1, 2], (aim[1, 0] * last + aim[1, 1]) * w + aim[1, 2]
    if not (min(x0, x1) >= 0.0 and min(y0, y1) >= 0.0 and max(x0, x1) < columns - 1 and max(y0, y1) < rows - 1):
        return False
    d0, d1 = (aim[2, 0] * first + aim[2, 1]) * z + aim[2, 2], (aim[2, 0] * last + aim[2, 1]) * w + aim[2, 2]
    deepest = max(d0, d1)
    left, right = int(min(x0, x1)) >> _BLOCK, int(max(x0, x1)) >> _BLOCK
    top, bottom = int(min(y0, y1)) >> _BLOCK, int(max(y0, y1)) >> _BLOCK
    if (right - left + 1) * (bottom - top + 1) > _RUN // 2:
        return False
    for block_row in range(top, bottom + 1):
        for block in range(left, right + 1):
            if deepest > coarse[block_row, block]:
                return False
    return True


@compiled_in_place
def sunshine(shadow: Any, coarse: Any, aim: Any, x: Any, inverse: Any) -> Any:
    """Return how much of the sun reaches what a pixel sees."""
    z = 1.0 / inverse
    return visibility(
        shadow, coarse, (aim[0, 0] * x + aim[0, 1]) * z + aim[0, 2], (aim[1, 0] * x + aim[1, 1]) * z + aim[1, 2],
        (aim[2, 0] * x + aim[2, 1]) * z + aim[2, 2],
    )  # fmt: skip


@compiled_loosely
def fill_background(line: Any, start: Any, stop: Any, dy: Any, fx: Any, cx: Any, background: Any, horizon: Any) -> None:
    """Colour the sky: one colour, or two that blend with the height over the horizon."""
    r0, g0, b0 = background[0, 0], background[0, 1], background[0, 2]
    r1, g1, b1 = background[1, 0], background[1, 1], background[1, 2]
    if r0 == r1 and g0 == g1 and b0 == b1:
        put(line, start, stop, r0, g0, b0, np.float32(1.0))
        return
    for x in range(start, stop):
        dx = (x - cx) / fx
        up = (horizon[0] * dx + horizon[1] * dy + horizon[2]) / math.sqrt(dx * dx + dy * dy + 1.0)
        share = math.sqrt(max(0.0, up))
        put_one(line, x, r0 + share * (r1 - r0), g0 + share * (g1 - g0), b0 + share * (b1 - b0), np.float32(1.0))


@compiled_loosely
def put(line: Any, start: Any, stop: Any, red: Any, green: Any, blue: Any, alpha: Any) -> None:
    """Give a run of pixels one colour."""
    if alpha >= 1.0:
        r, g, b = byte(red), byte(green), byte(blue)
        for x in range(start, stop):
            line[x, 0], line[x, 1], line[x, 2] = r, g, b
    else:
        for x in range(start, stop):
            put_one(line, x, red, green, blue, alpha)


@compiled_loosely
def put_one(line: Any, x: Any, red: Any, green: Any, blue: Any, alpha: Any) -> None:
    """Give one pixel a colour, mixed with what is there."""
    if alpha < 1.0:
        rest = (np.float32(1.0) - alpha) / np.float32(255.0)
        red = alpha * red + rest * line[x, 0]
        green = alpha * green + rest * line[x, 1]
        blue = alpha * blue + rest * line[x, 2]
    line[x, 0], line[x, 1], line[x, 2] = byte(red), byte(green), byte(blue)


@compiled_loosely
def byte(value: Any) -> Any:
    """Return 0..1 as 0..255."""
    return np.uint8(min(max(value, np.float32(0.0)), np.float32(1.0)) * np.float32(255.0) + np.float32(0.5))


@compiled_in_place
def visibility(shadow: Any, coarse: Any, x: Any, y: Any, depth: Any) -> Any:
    """Return how much of the sun reaches a place: the mean of four comparisons, weighted by nearness."""
    rows, columns = shadow.shape
    if not (x >= 0.0 and y >= 0.0 and x < columns - 1 and y < rows - 1):
        return np.float32(1.0)
    # Unsigned, so that no index can mean a place from the end.
    i, j = np.uint32(np.int32(x)), np.uint32(np.int32(y))
    d = np.float32(depth)
    if d <= coarse[j >> _BLOCK, i >> _BLOCK]:
        return np.float32(1.0)
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
    """Renew the coarse copy of a shadow map where rows and columns of `box` changed.

    A block holds the nearest depth of its pixels and of the next row and column, which `visibility` looks at.
    """
    rows, columns = shadow.shape
    size = 1 << _BLOCK
    for block_row in range(max(0, box[0] - 1) >> _BLOCK, (min(rows - 1, box[1]) >> _BLOCK) + 1):
        for block in range(max(0, box[2] - 1) >> _BLOCK, (min(columns - 1, box[3]) >> _BLOCK) + 1):
            nearest = np.float32(np.inf)
            for row in range(block_row * size, min(rows, block_row * size + size + 1)):
                for column in range(block * size, min(columns, block * size + size + 1)):
                    nearest = min(nearest, shadow[row, column])
            coarse[block_row, block] = nearest


@compiled_loosely
def lamp_light(lamp: Any, x: Any, y: Any, z: Any, nx: Any, ny: Any, nz: Any) -> Any:
    """Return how much light of a lamp arrives at a place with a normal."""
    if lamp[17] == 0.0:
        return 0.0
    length = math.sqrt(nx * nx + ny * ny + nz * nz) + 1e-12
    if lamp[0] == DIRECTIONAL:
        return max(0.0, -(nx * lamp[4] + ny * lamp[5] + nz * lamp[6]) / length)
    dx, dy, dz = lamp[1] - x, lamp[2] - y, lamp[3] - z
    distance = math.sqrt(dx * dx + dy * dy + dz * dz) + 1e-12
    if distance > lamp[10]:
        return 0.0
    facing = (nx * dx + ny * dy + nz * dz) / (distance * length)
    if facing <= 0.0:
        return 0.0
    light = facing / max(lamp[11] + lamp[12] * distance + lamp[13] * distance * distance, 1e-6)
    if lamp[0] == SPOT:
        along = -(dx * lamp[4] + dy * lamp[5] + dz * lamp[6]) / distance
        if along <= lamp[15]:
            return 0.0
        if along < lamp[14]:
            light *= ((along - lamp[15]) / (lamp[14] - lamp[15])) ** lamp[16]
    return light


@compiled_loosely
def mip_level(levels: Any, texture: Any, ux: Any, vx: Any, uy: Any, vy: Any) -> Any:
    """Return the row of the level whose texels are about as large as pixels."""
    first, count = texture[0], texture[1]
    width, height = levels[first, 1], levels[first, 2]
    across = (ux * width) ** 2 + (vx * height) ** 2
    along = (uy * width) ** 2 + (vy * height) ** 2
    size = max(across, along)
    if size <= 1.0:
        return first
    return first + min(count - 1, int(0.5 * math.log2(size) + 0.5))


@compiled_loosely
def sample(texels: Any, level: Any, u: Any, v: Any) -> Any:
    """Return the colour of a texture that repeats, between its four nearest texels."""
    first, width, height = level[0], level[1], level[2]
    x, y = u * width - 0.5, (1.0 - v) * height - 0.5
    left, top = math.floor(x), math.floor(y)
    s, t = np.float32(x - left), np.float32(y - top)
    i, j = int(left) % width, int(top) % height
    i1, j1 = i + 1 if i + 1 < width else 0, j + 1 if j + 1 < height else 0
    a, b = texels[first + j * width + i], texels[first + j * width + i1]
    c, d = texels[first + j1 * width + i], texels[first + j1 * width + i1]
    one, scale = np.float32(1.0), np.float32(1.0 / 255.0)
    wa, wb, wc, wd = (one - s) * (one - t) * scale, s * (one - t) * scale, (one - s) * t * scale, s * t * scale
    return (
        wa * a[0] + wb * b[0] + wc * c[0] + wd * d[0],
        wa * a[1] + wb * b[1] + wc * c[1] + wd * d[1],
        wa * a[2] + wb * b[2] + wc * c[2] + wd * d[2],
    )
