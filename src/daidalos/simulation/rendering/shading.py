"""Shading of pixels with light, shadow and textures, in one compiled loop over runs of pixels.

Everything that a run of pixels in one triangle needs is worked out once for the run; within it depth,
light and texture coordinates are linear or linear over depth.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from daidalos.common.kernels import compiled
from daidalos.simulation.rendering.lights import light_intensity
from daidalos.simulation.rendering.sunlight import aim_at_shadow, clear, sun_visibility
from daidalos.simulation.rendering.textures import mip_level, sample

HEMISPHERE = 0.2
"""How much more of the ambient light comes from above than from the side, and less from below, as a share."""

_RUN = 32
_SKY_RUN = 8


@compiled(fastmath=True)
def shade(
    triangles: Any,
    inverse: Any,
    edges: Any,
    flipped: Any,
    face_part: Any,
    face_shift: Any,
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
    lights: Any,
    shadow: Any,
    coarse: Any,
    to_shadow: Any,
    offset: Any,
    picture: Any,
    blend: Any,
) -> None:
    """Shade all pixels.

    Parameters
    ----------
    triangles, inverse, edges, flipped
        As `raster.draw` left them.
    face_part : array (t,) of int
        The part that each triangle belongs to.
    face_shift : array (p,) of int
        What is added to the number of a triangle of each part for its row in `faces`.
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
        Ambient light is that of a surface that stands upright; see `HEMISPHERE`.
    sun : array (3,)
        Unit vector towards the parallel light, in the camera's frame.
    lights : array (l, LIGHT_SIZE)
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
    aim = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
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
            at = face + face_shift[part]
            i, j, k = faces[at, 0], faces[at, 1], faces[at, 2]
            g0 = max(0.0, normals[i, 0] * sx + normals[i, 1] * sy + normals[i, 2] * sz)
            g1 = max(0.0, normals[j, 0] * sx + normals[j, 1] * sy + normals[j, 2] * sz)
            g2 = max(0.0, normals[k, 0] * sx + normals[k, 1] * sy + normals[k, 2] * sz)
            lit = sunny and g0 + g1 + g2 > 0.0
            # The same of the direction upwards, for ambient light.
            ux = turn * (pose[0, 0] * horizon[0] + pose[1, 0] * horizon[1] + pose[2, 0] * horizon[2])
            uy = turn * (pose[0, 1] * horizon[0] + pose[1, 1] * horizon[1] + pose[2, 1] * horizon[2])
            uz = turn * (pose[0, 2] * horizon[0] + pose[1, 2] * horizon[1] + pose[2, 2] * horizon[2])
            h0 = HEMISPHERE * (normals[i, 0] * ux + normals[i, 1] * uy + normals[i, 2] * uz)
            h1 = HEMISPHERE * (normals[j, 0] * ux + normals[j, 1] * uy + normals[j, 2] * uz)
            h2 = HEMISPHERE * (normals[k, 0] * ux + normals[k, 1] * uy + normals[k, 2] * uz)
            level = h0 == h1 and h1 == h2
            red, green, blue = colors[part, 0], colors[part, 1], colors[part, 2]
            # The colour in the shade, and what the full sun adds.
            ar, ag, ab = red * ambient[0], green * ambient[1], blue * ambient[2]
            sr, sg, sb = red * sun_color[0], green * sun_color[1], blue * sun_color[2]
            gr, gg, gb = emissions[part, 0], emissions[part, 1], emissions[part, 2]
            alpha = alphas[part] if blend else np.float32(1.0)
            plain = texture_of[part] < 0 and len(lights) == 0
            if plain and level and not lit:
                put(line, start, column, ar + h0 * ar + gr, ag + h0 * ag + gg, ab + h0 * ab + gb, alpha)
                continue
            casts = lit and shadowed
            flat = plain and level and g0 == g1 and g1 == g2
            if flat:
                ar, ag, ab = ar + h0 * ar + gr, ag + h0 * ag + gg, ab + h0 * ab + gb
                # The colour in the sun.
                sr, sg, sb = ar + g0 * sr, ag + g0 * sg, ab + g0 * sb
            if flat and not casts:
                put(line, start, column, sr, sg, sb, alpha)
                continue
            # Light over depth: linear.
            e = edges[face]
            slope = np.float32(g0 * e[0] + g1 * e[3] + g2 * e[6])
            base = np.float32(g0 * (e[1] * row + e[2]) + g1 * (e[4] * row + e[5]) + g2 * (e[7] * row + e[8]))
            rise = np.float32(h0 * e[0] + h1 * e[3] + h2 * e[6])
            foot = np.float32(h0 * (e[1] * row + e[2]) + h1 * (e[4] * row + e[5]) + h2 * (e[7] * row + e[8]))
            if casts:
                nx = turn * (normals[i, 0] + normals[j, 0] + normals[k, 0]) / 3
                ny = turn * (normals[i, 1] + normals[j, 1] + normals[k, 1]) / 3
                nz = turn * (normals[i, 2] + normals[j, 2] + normals[k, 2]) / 3
                aim = aim_at_shadow(to_shadow, offset, pose, nx, ny, nz, dy, fx, cx)
            for first in range(start, column, _RUN):
                last = min(first + _RUN, column)
                dark = casts and not clear(shadow, coarse, aim, first, depths[first], last - 1, depths[last - 1])
                if flat and not dark:
                    put(line, first, last, sr, sg, sb, alpha)
                elif flat:
                    for x in range(first, last, 2):
                        shine = sun_visibility(shadow, aim, x, depths[x])
                        put(line, x, min(x + 2, last), ar + shine * (sr - ar), ag + shine * (sg - ag),
                            ab + shine * (sb - ab), alpha)  # fmt: skip
                elif not plain:
                    paint_rich(
                        line, depths, first, last, row, e, i, j, k, part, dy, turn, normals, uv, pose, colors,
                        emissions, alpha, texture_of, texels, texture_levels, levels, fx, cx, ambient, sun_color,
                        lights, slope, base, rise, foot, dark, shadow, aim,
                    )  # fmt: skip
                elif dark:
                    shine = np.float32(1.0)
                    for x in range(first, last):
                        # Every other pixel is asked, and its neighbour's answer taken.
                        if (x - first) & 1 == 0:
                            shine = sun_visibility(shadow, aim, x, depths[x])
                        z = np.float32(1.0) / depths[x]
                        g = (base + slope * np.float32(x)) * z * shine
                        h = (foot + rise * np.float32(x)) * z
                        put_one(line, x, ar + h * ar + g * sr + gr, ag + h * ag + g * sg + gg,
                                ab + h * ab + g * sb + gb, alpha)  # fmt: skip
                else:
                    for x in range(first, last):
                        z = np.float32(1.0) / depths[x]
                        g, h = (base + slope * np.float32(x)) * z, (foot + rise * np.float32(x)) * z
                        put_one(line, x, ar + h * ar + g * sr + gr, ag + h * ag + g * sg + gg,
                                ab + h * ab + g * sb + gb, alpha)  # fmt: skip


@compiled(fastmath=True)
def paint_rich(
    line: Any,
    depths: Any,
    first: Any,
    last: Any,
    row: Any,
    e: Any,
    i: Any,
    j: Any,
    k: Any,
    part: Any,
    dy: Any,
    turn: Any,
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
    lights: Any,
    slope: Any,
    base: Any,
    rise: Any,
    foot: Any,
    dark: Any,
    shadow: Any,
    aim: Any,
) -> None:
    """Shade the pixels of one triangle with a texture, or with point lights and spot lights."""
    a0, a1, a2 = e[0], e[3], e[6]
    r0, r1, r2 = e[1] * row + e[2], e[4] * row + e[5], e[7] * row + e[8]
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
            g *= sun_visibility(shadow, aim, x, depths[x])
        h = 1.0 + (foot + rise * np.float32(x)) * z
        red, green, blue = h * ambient[0], h * ambient[1], h * ambient[2]
        red, green, blue = red + g * sun_color[0], green + g * sun_color[1], blue + g * sun_color[2]
        if len(lights) > 0:
            w0, w1, w2 = turn * (a0 * x + r0) * z, turn * (a1 * x + r1) * z, turn * (a2 * x + r2) * z
            nx = w0 * normals[i, 0] + w1 * normals[j, 0] + w2 * normals[k, 0]
            ny = w0 * normals[i, 1] + w1 * normals[j, 1] + w2 * normals[k, 1]
            nz = w0 * normals[i, 2] + w1 * normals[j, 2] + w2 * normals[k, 2]
            cnx = pose[0, 0] * nx + pose[0, 1] * ny + pose[0, 2] * nz
            cny = pose[1, 0] * nx + pose[1, 1] * ny + pose[1, 2] * nz
            cnz = pose[2, 0] * nx + pose[2, 1] * ny + pose[2, 2] * nz
            for light in lights:
                g = light_intensity(light, (x - cx) / fx * z, dy * z, z, cnx, cny, cnz)
                red, green, blue = red + g * light[7], green + g * light[8], blue + g * light[9]
        if texture >= 0:
            tr, tg, tb = sample(texels, levels[level], (ua * x + ur) * z, (va * x + vr) * z)
            red, green, blue = red * tr, green * tg, blue * tb
        put_one(line, x, colors[part, 0] * red + emissions[part, 0], colors[part, 1] * green + emissions[part, 1],
                colors[part, 2] * blue + emissions[part, 2], alpha)  # fmt: skip


@compiled(fastmath=True)
def fill_background(line: Any, start: Any, stop: Any, dy: Any, fx: Any, cx: Any, background: Any, horizon: Any) -> None:
    """Fill the sky with one colour, or with two that blend by the height above the horizon.

    A few pixels of a row have one colour: along a row it hardly changes.
    """
    r0, g0, b0 = background[0, 0], background[0, 1], background[0, 2]
    r1, g1, b1 = background[1, 0], background[1, 1], background[1, 2]
    if r0 == r1 and g0 == g1 and b0 == b1:
        put(line, start, stop, r0, g0, b0, np.float32(1.0))
        return
    for first in range(start, stop, _SKY_RUN):
        last = min(first + _SKY_RUN, stop)
        share = sky_share((0.5 * (first + last) - cx) / fx, dy, horizon)
        put(line, first, last, r0 + share * (r1 - r0), g0 + share * (g1 - g0), b0 + share * (b1 - b0), np.float32(1.0))


@compiled(fastmath=True)
def sky_share(dx: Any, dy: Any, horizon: Any) -> Any:
    """Return how much of the colour overhead a ray has: 0 at the horizon and below."""
    up = (horizon[0] * dx + horizon[1] * dy + horizon[2]) / math.sqrt(dx * dx + dy * dy + 1.0)
    return np.float32(math.sqrt(max(0.0, up)))


@compiled(fastmath=True)
def put(line: Any, start: Any, stop: Any, red: Any, green: Any, blue: Any, alpha: Any) -> None:
    """Set a run of pixels to one colour."""
    if alpha >= 1.0:
        r, g, b = byte(red), byte(green), byte(blue)
        for x in range(start, stop):
            line[x, 0], line[x, 1], line[x, 2] = r, g, b
    else:
        for x in range(start, stop):
            put_one(line, x, red, green, blue, alpha)


@compiled(fastmath=True)
def put_one(line: Any, x: Any, red: Any, green: Any, blue: Any, alpha: Any) -> None:
    """Blend a colour into one pixel."""
    if alpha < 1.0:
        rest = (np.float32(1.0) - alpha) / np.float32(255.0)
        red = alpha * red + rest * line[x, 0]
        green = alpha * green + rest * line[x, 1]
        blue = alpha * blue + rest * line[x, 2]
    line[x, 0], line[x, 1], line[x, 2] = byte(red), byte(green), byte(blue)


@compiled(fastmath=True)
def byte(value: Any) -> Any:
    """Convert 0..1 to 0..255."""
    return np.uint8(min(max(value, np.float32(0.0)), np.float32(1.0)) * np.float32(255.0) + np.float32(0.5))
