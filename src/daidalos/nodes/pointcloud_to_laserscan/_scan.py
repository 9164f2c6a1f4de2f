"""Nearest points of a cloud, by direction."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Slice:
    """Limits of the points that form a scan.

    Attributes
    ----------
    min_height, max_height : float
        Of the points, z [m].
    angle_min, angle_max, angle_increment : float
        The scan's rays [rad].
    range_min, range_max : float
        Distances from the z axis [m].
    empty : float
        The range of a ray without a point [m].
    """

    min_height: float
    max_height: float
    angle_min: float
    angle_max: float
    angle_increment: float
    range_min: float
    range_max: float
    empty: float = math.inf

    @property
    def count(self) -> int:
        """Number of rays of the scan."""
        return math.ceil((self.angle_max - self.angle_min) / self.angle_increment)

    def ranges(self, points: NDArray[np.floating]) -> NDArray[np.float32]:
        """Return the distance of the nearest point in each ray's sector, (count,).

        Parameters
        ----------
        points : array of shape (n, 3)
            In the scan's frame [m]; those that are not numbers are passed over.
        """
        x, y, z = points.astype(np.float64).T
        distances, angles = np.hypot(x, y), np.arctan2(y, x)
        kept = (z >= self.min_height) & (z <= self.max_height)
        kept &= (distances >= self.range_min) & (distances <= self.range_max)
        kept &= (angles >= self.angle_min) & (angles <= self.angle_max)
        rays = ((angles[kept] - self.angle_min) / self.angle_increment).astype(int)
        ranges = np.full(self.count, np.inf)
        # An angle of just the maximum is beyond the last sector.
        inside = rays < self.count
        np.minimum.at(ranges, rays[inside], distances[kept][inside])
        ranges[np.isinf(ranges)] = self.empty
        return ranges.astype(np.float32)
