"""Kernels of the contact of a disc with a height field, and of the removal by it.

The face of the disc is a plane that is pressed downwards along its normal. Each cell of the field carries a pressure in
proportion to its depth above the plane; a lumped law is in series. Both are condensed into a table of forces over
depths, so that the dynamics need no cells. With a plane of the slopes (gx, gy), depths along the normal are those along
z times the normal's cosine, and areas are those in the plane of the field divided by it: forces need neither.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from daidalos.common.kernels import compiled

BINS = 128
"""Number of depths in the table."""
BESIDE = -1e30
"""Height of the first touch where the disc is beside the field [m]."""
_BLOCK = 32
MAX_DEPTH = 1e-3
"""Greatest depth of the face in the table [m]."""


@compiled(inline=True)
def _chord(y: float, gx: float, gy: float, radius: float) -> tuple[float, float]:
    """Return the least and the greatest x inside a circle of the face, at a distance y from its centre; 1, 0: none."""
    a, b, c = 1.0 + gx * gx, gx * gy * y, y * y * (1.0 + gy * gy) - radius * radius
    root = b * b - a * c
    if root <= 0.0:
        return 1.0, 0.0
    root = math.sqrt(root)
    return (-b - root) / a, (-b + root) / a


@compiled(inline=True)
def _columns(
    y: float, disc: NDArray[np.float64], origin_x: float, resolution: float, columns: int
) -> tuple[int, int, int, int]:
    """Return the columns inside the disc at a distance y from its centre.

    The first and the one behind the last, on both sides of the part that is set back.
    """
    begin, end = _chord(y, disc[2], disc[3], disc[4])
    if begin > end:
        return 0, 0, 0, 0
    shift = disc[0] - origin_x
    first = max(math.ceil((begin + shift) / resolution), 0)
    last = min(math.floor((end + shift) / resolution) + 1, columns)
    begin, end = _chord(y, disc[2], disc[3], disc[5])
    if begin > end or last <= first:
        return first, max(last, first), first, first
    left = min(max(math.ceil((begin + shift) / resolution), first), last)
    right = min(max(math.floor((end + shift) / resolution) + 1, first), last)
    return first, left, right, last


@compiled(fastmath=True)
def _highest(row: NDArray[np.float64], ramp: NDArray[np.float64], top: float) -> float:
    """Return the greatest height of a row above a ramp, at least `top`; four at a time, which is twice as fast."""
    one = two = three = four = top
    whole = row.shape[0] // 4 * 4
    for index in range(0, whole, 4):
        one = max(one, row[index] - ramp[index])
        two = max(two, row[index + 1] - ramp[index + 1])
        three = max(three, row[index + 2] - ramp[index + 2])
        four = max(four, row[index + 3] - ramp[index + 3])
    for index in range(whole, row.shape[0]):
        one = max(one, row[index] - ramp[index])
    return max(max(one, two), max(three, four))


@compiled
def _count(
    row: NDArray[np.float64],
    ramp: NDArray[np.float64],
    top: float,
    counts: NDArray[np.float64],
    sums: NDArray[np.float64],
) -> None:
    """Add the cells of a row to a histogram of their depths below `top`; those that are too deep go by in blocks."""
    for begin in range(0, row.shape[0], _BLOCK):
        end = min(begin + _BLOCK, row.shape[0])
        if _highest(row[begin:end], ramp[begin:end], BESIDE) < top - MAX_DEPTH:
            continue
        for index in range(begin, end):
            below = top - (row[index] - ramp[index])
            if below < MAX_DEPTH:
                place = min(int(BINS * math.sqrt(max(below, 0.0) / MAX_DEPTH)), BINS - 1)
                counts[place] += 1.0
                sums[place] += below


@compiled
def press(
    heights: NDArray[np.float64],
    origin: NDArray[np.float64],
    resolution: float,
    disc: NDArray[np.float64],
    contact: NDArray[np.float64],
    is_hertz: bool,
    depths: NDArray[np.float64],
    faces: NDArray[np.float64],
    forces: NDArray[np.float64],
) -> float:
    """Compute how a disc's force depends on its depth.

    Parameters
    ----------
    heights
        Of the surface, (rows, columns), rows along y [m].
    origin
        x and y of the cell [0, 0] [m].
    resolution
        Edge of a cell [m].
    disc
        x, y of the centre [m], slopes of the face along x and y, outer and inner radius [m].
    contact
        Stiffness of the lumped law, and that of the face [Pa/m].
    is_hertz
        Whether the lumped law has the exponent 1.5.
    depths, faces, forces
        Out (BINS + 1): depths of the disc along its normal beyond the first touch, those of its face, along z, and
        forces along the normal.

    Returns
    -------
    float
        Height of the centre of the face at the first touch [m]; `BESIDE` where the disc is beside the field.
    """
    rows, columns = heights.shape
    cx, cy, gx, gy, outer = disc[0], disc[1], disc[2], disc[3], disc[4]
    first_row = max(math.ceil((cy - outer - origin[1]) / resolution), 0)
    end_row = min(math.floor((cy + outer - origin[1]) / resolution) + 1, rows)
    ramp = gx * resolution * np.arange(columns)
    top = BESIDE
    for row in range(first_row, end_row):
        y = origin[1] + row * resolution - cy
        first, left, right, end = _columns(y, disc, origin[0], resolution, columns)
        shift = gy * y + gx * (origin[0] - cx)
        highest = _highest(heights[row, first:left], ramp[first:left], BESIDE)
        top = max(top, _highest(heights[row, right:end], ramp[right:end], highest) - shift)
    for index in range(BINS + 1):
        depths[index] = faces[index] = forces[index] = 0.0
    if top < 0.5 * BESIDE:
        return BESIDE
    counts, sums = np.zeros(BINS), np.zeros(BINS)
    for row in range(first_row, end_row):
        y = origin[1] + row * resolution - cy
        first, left, right, end = _columns(y, disc, origin[0], resolution, columns)
        level = top + gy * y + gx * (origin[0] - cx)
        _count(heights[row, first:left], ramp[first:left], level, counts, sums)
        _count(heights[row, right:end], ramp[right:end], level, counts, sums)
    cosine = 1.0 / math.sqrt(1.0 + gx * gx + gy * gy)
    count, total = 0.0, 0.0
    for index in range(1, BINS + 1):
        face = MAX_DEPTH * (index / BINS) ** 2
        count += counts[index - 1]
        total += sums[index - 1]
        force = contact[1] * (count * face - total) * resolution * resolution
        lumped = (force / contact[0]) ** (2.0 / 3.0) if is_hertz else force / contact[0]
        faces[index], forces[index], depths[index] = face, force, face * cosine + lumped
    return top


@compiled(inline=True)
def interpolate(at: float, x: NDArray[np.float64], y: NDArray[np.float64]) -> tuple[float, float]:
    """Return the value and the slope of a table that begins with 0, 0; beyond its end it goes on."""
    if at <= 0.0:
        return 0.0, 0.0
    low, high = 0, x.shape[0] - 1
    while high - low > 1:
        middle = (low + high) // 2
        if x[middle] <= at:
            low = middle
        else:
            high = middle
    slope = (y[high] - y[low]) / max(x[high] - x[low], 1e-15)
    return y[low] + slope * (at - x[low]), slope


@compiled
def remove(
    heights: NDArray[np.float64],
    origin: NDArray[np.float64],
    resolution: float,
    disc: NDArray[np.float64],
    plane: float,
    rate: float,
    removed: NDArray[np.float64],
) -> None:
    """Remove what a disc grinds off by Preston's law.

    Parameters
    ----------
    heights, origin, resolution, disc
        As in `press`; the heights are changed.
    plane
        Height of the centre of the face [m].
    rate
        Removed depth per depth of the face and radius, at most 1 per radius: coefficient of Preston, stiffness of the
        face, speed of the spindle and time, multiplied [1/m].
    removed
        Out (3): removed volume [m^3], mean radius of the contact weighted by pressure [m], area of the contact [m^2].
    """
    rows, columns = heights.shape
    cx, cy, gx, gy, outer = disc[0], disc[1], disc[2], disc[3], disc[4]
    first_row = max(math.ceil((cy - outer - origin[1]) / resolution), 0)
    end_row = min(math.floor((cy + outer - origin[1]) / resolution) + 1, rows)
    slope = gx * resolution
    volume, moment, pressed, count = 0.0, 0.0, 0.0, 0.0
    for row in range(first_row, end_row):
        y = origin[1] + row * resolution - cy
        first, left, right, end = _columns(y, disc, origin[0], resolution, columns)
        shift = plane + gy * y + gx * (origin[0] - cx)
        for side in range(2):
            for column in range(first if side == 0 else right, left if side == 0 else end):
                depth = heights[row, column] - shift - slope * column
                if depth > 0.0:
                    x = origin[0] + column * resolution - cx
                    radius = math.sqrt(x * x + y * y + (gx * x + gy * y) ** 2)
                    off = depth * min(rate * radius, 1.0)
                    heights[row, column] -= off
                    volume += off
                    moment += depth * radius
                    pressed += depth
                    count += 1.0
    area = resolution * resolution
    removed[0] = volume * area
    removed[1] = moment / pressed if pressed > 0.0 else 0.0
    removed[2] = count * area
