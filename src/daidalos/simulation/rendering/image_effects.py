"""Image effects of cameras: distortion, noise and Bayer mosaic, as compiled loops over pixels."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from daidalos.common.kernels import compiled


@compiled
def distort(ideal: Any, lookup: Any, bent: Any) -> None:
    """Resample a picture with bilinear interpolation of the undistorted one.

    Parameters
    ----------
    ideal : array (rows, columns, 3) of uint8
    lookup : array (height, width, 2) of float32
        Column and row in `ideal`.
    bent : array (height, width, 3) of uint8
        The result.
    """
    rows, columns = ideal.shape[:2]
    for row in range(lookup.shape[0]):
        for column in range(lookup.shape[1]):
            x = min(max(lookup[row, column, 0], 0.0), columns - 1.0)
            y = min(max(lookup[row, column, 1], 0.0), rows - 1.0)
            i, j = min(int(x), columns - 2), min(int(y), rows - 2)
            s, t = x - i, y - j
            for band in range(3):
                upper = (1 - s) * ideal[j, i, band] + s * ideal[j, i + 1, band]
                lower = (1 - s) * ideal[j + 1, i, band] + s * ideal[j + 1, i + 1, band]
                bent[row, column, band] = np.uint8((1 - t) * upper + t * lower + 0.5)


@compiled
def pick(ideal: Any, lookup: Any, bent: Any) -> None:
    """Resample an array with the nearest pixel of the undistorted one, for depths and labels."""
    rows, columns = ideal.shape
    for row in range(lookup.shape[0]):
        for column in range(lookup.shape[1]):
            i = min(max(math.floor(lookup[row, column, 0] + 0.5), 0), columns - 1)
            j = min(max(math.floor(lookup[row, column, 1] + 0.5), 0), rows - 1)
            bent[row, column] = ideal[j, i]


@compiled
def add_noise(picture: Any, noise: Any, start: Any) -> None:
    """Add values of a table, from an offset on and cyclically, to the bytes of a picture."""
    place, done = start, 0
    while done < len(picture):
        # Runs without wrapping, which the compiler vectorizes.
        run = min(len(picture) - done, len(noise) - place)
        pixels, values = picture[done : done + run], noise[place : place + run]
        for index in range(run):
            value = pixels[index] + values[index]
            pixels[index] = np.uint8(min(max(value, np.float32(0.0)), np.float32(255.0)) + np.float32(0.5))
        done += run
        place = 0


@compiled
def mosaic(picture: Any, pattern: Any, raw: Any) -> None:
    """Keep one colour band per pixel, by its position in a two by two pattern."""
    for row in range(raw.shape[0]):
        for column in range(raw.shape[1]):
            raw[row, column] = picture[row, column, pattern[row & 1, column & 1]]


@compiled
def depths_of(inverse: Any, triangles: Any, near: Any, far: Any, depths: Any) -> None:
    """Convert inverse depths to depths [m]: infinite for misses and beyond range, minus infinite if too near."""
    rows, columns = inverse.shape
    infinite = np.float32(np.inf)
    for row in range(rows):
        for column in range(columns):
            depth = np.float32(1.0) / inverse[row, column]
            depth = infinite if triangles[row, column] < 0 or depth > far else depth
            depths[row, column] = -infinite if depth < near else depth


@compiled
def points_of(depths: Any, rays: Any, points: Any) -> None:
    """Compute the 3-D point of each pixel from its depth (rows, columns, 3); NaN if out of range."""
    rows, columns = depths.shape
    none = np.float32(np.nan)
    for row in range(rows):
        for column in range(columns):
            depth = depths[row, column]
            depth = depth if np.isfinite(depth) else none
            points[row, column, 0] = depth * rays[row, column, 0]
            points[row, column, 1] = depth * rays[row, column, 1]
            points[row, column, 2] = depth * rays[row, column, 2]
