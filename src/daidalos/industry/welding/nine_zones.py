"""The test paths of the workshop on path correction: the straight line, and a curve of nine zones.

The workshop prints neither the place of the line nor the curve. The line's place is the one at which the published
stiffness gives the printed deflections; the directions of the curve's zones 1, 3, 5, 7 and 9 are those for which a
deviation away from the robot's base has the printed shares ahead and across, and arcs join them.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from daidalos.industry.welding.seam import Seam

LINE_POINTS = 100
LINE_LENGTH = 0.4
HEADINGS = tuple(math.radians(angle) for angle in (235.0, 326.0, 252.0, 135.0, 225.0))
STRAIGHT_LENGTH = 0.06
ARC_RADIUS = 0.04
CURVE_STEP = 1e-3
CURVE_CENTRE = (2.06, 0.0, 0.9)
"""Middle of the curve [m]; at this distance from axis 1 its printed backlash moves the tool by +-1.5 mm."""


def straight_line() -> Seam:
    """Return the line of 100 points, across the direction in which the arm points."""
    positions = np.column_stack(
        [
            np.full(LINE_POINTS, 2.3),
            np.linspace(0.5 * LINE_LENGTH, -0.5 * LINE_LENGTH, LINE_POINTS),
            np.full(LINE_POINTS, 0.9),
        ]
    )
    return Seam(positions, _upwards(LINE_POINTS))


def nine_zone_curve() -> Seam:
    """Return the curve: five straight zones with odd numbers, and four arcs between them with even numbers."""
    headings, zones = [], []
    for number, heading in enumerate(HEADINGS):
        count = round(STRAIGHT_LENGTH / CURVE_STEP)
        headings += [heading] * count
        zones += [str(2 * number + 1)] * count
        if number + 1 < len(HEADINGS):
            turn = HEADINGS[number + 1] - heading
            count = round(abs(turn) * ARC_RADIUS / CURVE_STEP)
            headings += (heading + turn * (np.arange(count) + 0.5) / count).tolist()
            zones += [str(2 * number + 2)] * count
    steps = CURVE_STEP * np.column_stack([np.cos(headings), np.sin(headings)])
    plane = np.concatenate([[[0.0, 0.0]], np.cumsum(steps, axis=0)])
    plane -= 0.5 * (plane.max(axis=0) + plane.min(axis=0))
    positions = np.column_stack([plane, np.zeros(len(plane))]) + CURVE_CENTRE
    return Seam(positions, _upwards(len(positions)), zones=(*zones, zones[-1]))


def _upwards(count: int) -> NDArray[np.float64]:
    return np.tile([0.0, 0.0, 1.0], (count, 1))
