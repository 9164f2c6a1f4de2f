"""Calibration of a video projector by a camera: circles at known points, and discs that the projector shows."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.industry.assistance.circles import DetectionError, find_circles, find_light, locate
from daidalos.industry.assistance.homography import MIN_PAIRS
from daidalos.industry.assistance.video_projector import draw_disc

Array = NDArray[np.float64]
_GRID = (0.15, 0.5, 0.85)
"""Places of the discs, as shares of the projector's picture."""

_RADIUS = 1 / 40
"""Radius of a disc, as a share of the picture's width."""


@dataclass(frozen=True)
class Pairs:
    """Points of the plane ``(n, 2)`` [m] and the projector's pixels ``(n, 2)`` that lie there."""

    points: Array
    pixels: Array


def measure_pairs(
    known: Sequence[Sequence[float]],
    size: tuple[int, int],
    show: Callable[[bytes], None],
    take: Callable[[], Array],
    report: Callable[[str], None],
) -> Pairs:
    """Measure where pixels of a projector lie on a plane.

    Parameters
    ----------
    known : sequence of (x, y)
        Points of the plane with a dark, filled circle at each [m].
    size : (int, int)
        Width and height of the projector's picture [pixels].
    show : callable
        Shows a picture in PNG.
    take : callable
        Returns the brightness ``(height, width)`` of a picture of the camera, taken after the last call of `show`.
    report : callable
        Called with a line for each step.

    Raises
    ------
    DetectionError
        When circles or discs are not seen.
    """
    width, height = size
    show(draw_disc(size, (0.0, 0.0), 0.0))
    dark = take()
    camera = locate(np.asarray(known, dtype=float), find_circles(dark), dark.shape[1])
    report(f"circles: all {len(known)} found, residual {camera.residual:.2f} pixels of the camera")
    points, pixels = [], []
    for column, row in ((x * width, y * height) for y in _GRID for x in _GRID):
        show(draw_disc(size, (column, row), _RADIUS * width))
        spot = find_light(dark, take())
        if spot is None:
            report(f"the disc at pixel [{column:g}, {row:g}] is not seen")
            continue
        x, y = camera.points(spot)[0]
        report(f"pixel [{column:g}, {row:g}] lies at [{x:.3f}, {y:.3f}]")
        points.append((float(x), float(y)))
        pixels.append((column, row))
    if len(points) < MIN_PAIRS:
        raise DetectionError(
            f"the camera sees {len(points)} discs of the projector, {MIN_PAIRS} are needed; darken the room"
        )
    return Pairs(np.array(points), np.array(pixels))
