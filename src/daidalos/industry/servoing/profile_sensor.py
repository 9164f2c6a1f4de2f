"""Simulated laser profile sensor with the ranges of a Keyence LJ-V7080: heights over 800 points across the seam."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.industry.servoing.butt_joint import ButtJoint

POINTS = 800
PITCH = 0.05e-3
"""Distance between points [m]."""
REFERENCE = 0.080
"""Distance of height 0 [m]."""
HEIGHT_RANGE = 0.023
"""Greatest height above and below [m]."""
WIDTH, WIDTH_CHANGE = 0.032, 0.007
"""Measured width at the reference distance, and what it is more or less at the ends of the range [m]."""
COLUMNS = (np.arange(POINTS) - 0.5 * (POINTS - 1)) * PITCH
"""Places of the points across the sensor, to its left (POINTS,) [m]."""


@dataclass(frozen=True)
class Disturbances:
    """What disturbs a measurement.

    Attributes
    ----------
    noise : float
        Standard deviation of heights [m].
    glossy_noise : float
        The same in glossy spots [m].
    spikes, missing, glossy_missing : float
        Shares of points with wrong heights, without heights, and without heights in glossy spots.
    gap_missing : float
        Share of the points in the gap without heights.
    edge_radius : float
        Of the plates' edges [m].
    """

    noise: float = 5e-6
    glossy_noise: float = 40e-6
    spikes: float = 0.003
    missing: float = 0.01
    glossy_missing: float = 0.3
    gap_missing: float = 0.6
    edge_radius: float = 0.05e-3


class ProfileSensor:
    """A sensor that looks down on a joint.

    Parameters
    ----------
    joint : ButtJoint
    seed : int
        Of the noise.
    disturbances : Disturbances
    """

    def __init__(self, joint: ButtJoint, seed: int = 0, disturbances: Disturbances | None = None) -> None:
        self._joint = joint
        self._rng = np.random.default_rng(seed)
        self._disturbances = disturbances or Disturbances()

    def measure(self, s: float, lateral: float, height: float = 0.0, roll: float = 0.0) -> NDArray[np.float64]:
        """Return the heights at `COLUMNS` (POINTS,) [m], upwards; NaN where there is none.

        Parameters
        ----------
        s, lateral : float
            Place of the sensor along and to the left of the programmed path [m].
        height : float
            Of the sensor above its reference distance from the right plate [m].
        roll : float
            Rotation of the sensor about the direction of the path [rad].
        """
        right, left = self._joint.edges(s)
        across = np.asarray(COLUMNS + lateral, dtype=np.float64)
        heights = self._surface(across, right, left) - height - math.tan(roll) * COLUMNS
        self._disturb(heights, across, s, right, left)
        width = WIDTH + WIDTH_CHANGE * np.clip(-heights / HEIGHT_RANGE, -1.0, 1.0)
        heights[(np.abs(heights) > HEIGHT_RANGE) | (np.abs(COLUMNS) > 0.5 * width)] = np.nan
        return heights

    def _surface(self, across: NDArray[np.float64], right: float, left: float) -> NDArray[np.float64]:
        """Return the heights of the plates, rounded at their edges, and of what is seen in the gap (n,)."""
        radius = self._disturbances.edge_radius
        inside = np.maximum(right - across, across - left)  # of a plate, from its edge
        rounded = radius - np.sqrt(np.maximum(radius**2 - np.clip(radius - inside, 0.0, radius) ** 2, 0.0))
        heights: NDArray[np.float64] = np.where(across > 0.5 * (right + left), self._joint.mismatch, 0.0) - rounded
        in_gap = inside < 0.0
        heights[in_gap] += 2.0 * inside[in_gap] - radius - 0.2e-3
        return heights

    def _disturb(
        self, heights: NDArray[np.float64], across: NDArray[np.float64], s: float, right: float, left: float
    ) -> None:
        """Add noise, spikes and missing points to heights (POINTS,)."""
        rng, given = self._rng, self._disturbances
        glossy = np.zeros(POINTS, dtype=bool)
        for place, beside, along, half in self._joint.glossy:
            if abs(s - place) < along:
                glossy |= np.abs(across - 0.5 * (right + left) - beside) < half
        heights += rng.normal(size=POINTS) * np.where(glossy, given.glossy_noise, given.noise)
        chance = rng.random(POINTS)
        spikes = chance < given.spikes
        heights[spikes] += rng.uniform(-5e-3, 5e-3, int(spikes.sum()))
        lost = np.where(glossy, given.glossy_missing, given.missing)
        lost = np.where((across > right) & (across < left), given.gap_missing, lost)
        heights[rng.random(POINTS) < lost] = np.nan
