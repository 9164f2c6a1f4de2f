"""Evaluation of profiles of a butt joint: the edges FP1 and FP2, gap, height, mismatch and angle, with a quality."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.industry.servoing.profile_kernels import find_joint
from daidalos.industry.servoing.profile_sensor import PITCH

MIN_QUALITY = 0.3
"""Quality below which a joint does not count as seen."""


@dataclass(frozen=True)
class Evaluation:
    """A joint as a profile shows it, in the axes of the sensor.

    Attributes
    ----------
    fp1, fp2 : tuple of float
        Edge of the right and of the left plate: place to the left, and height [m].
    gap : float
        Between the edges [m].
    height : float
        Mean of the edges' heights [m].
    mismatch : float
        Height of the left plate above the right one [m].
    angle : float
        Of the plates across the sensor [rad].
    quality : float
        From 0 to 1.
    """

    fp1: tuple[float, float]
    fp2: tuple[float, float]
    gap: float
    height: float
    mismatch: float
    angle: float
    quality: float

    @property
    def centre(self) -> float:
        """Middle of the gap, to the left of the sensor [m]."""
        return 0.5 * (self.fp1[0] + self.fp2[0])

    def as_json(self) -> dict[str, object]:
        """Return the figures [m, rad]."""
        return asdict(self)


def evaluate(
    heights: NDArray[np.float64], pitch: float = PITCH, expected: float = math.nan, min_quality: float = MIN_QUALITY
) -> Evaluation | None:
    """Return the joint in a profile; None where none is seen.

    Parameters
    ----------
    heights : array of shape (n,)
        Equally spaced points, the middle of the profile at 0; NaN where there is no height [m].
    pitch : float
        Distance between points [m].
    expected : float
        Where the middle of the gap is expected [m].
    min_quality : float
        Quality from which the joint counts as seen.
    """
    found = find_joint(np.ascontiguousarray(heights, dtype=np.float64), pitch, expected)
    right, left, right_height, left_height, right_slope, left_slope, _, quality = (float(one) for one in found)
    if quality < min_quality or quality == 0.0:
        return None
    return Evaluation(
        (right, right_height),
        (left, left_height),
        left - right,
        0.5 * (right_height + left_height),
        left_height - right_height,
        math.atan(0.5 * (right_slope + left_slope)),
        quality,
    )
