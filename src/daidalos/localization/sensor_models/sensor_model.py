"""Contract of sensor models, and the beams that they evaluate."""

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.localization.config import AmclConfig
from daidalos.localization.likelihood_map import LikelihoodMap
from daidalos.mapping.scan import LaserScanData, directions


@dataclass(frozen=True)
class Beams:
    """Selected beams of a scan.

    Attributes
    ----------
    ranges : ndarray, shape (k,)
        Distances [m]; the largest range where a beam met nothing.
    angles : ndarray, shape (k,)
        Directions [rad] in the sensor's frame.
    max_range : float
        Largest range [m].
    sensor_pose : ndarray, shape (3,)
        Pose of the sensor in the frame of the base.
    """

    ranges: Array
    angles: Array
    max_range: float
    sensor_pose: Array

    @property
    def ends(self) -> Array:
        """Ends (k, 2) of the beams that met something, in the frame of the base [m]."""
        met = self.ranges < self.max_range
        angle = self.sensor_pose[2] + self.angles[met]
        direction = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
        ends: Array = self.sensor_pose[:2] + self.ranges[met, None] * direction
        return ends

    @classmethod
    def of_scan(cls, scan: LaserScanData, config: AmclConfig) -> "Beams":
        """Select evenly spread beams of a scan, without invalid measurements."""
        ranges = np.asarray(scan.ranges, dtype=np.float64)
        count = min(config.max_beams, ranges.size)
        chosen = np.unique(np.linspace(0, ranges.size - 1, count).astype(np.int64))
        nearest = config.laser_min_range if config.laser_min_range > 0.0 else scan.range_min
        farthest = min(scan.range_max, config.laser_max_range)
        if config.laser_max_range <= 0.0:
            farthest = scan.range_max
        if not math.isfinite(farthest):
            farthest = 1e3
        picked = np.minimum(ranges[chosen], farthest)
        angles = scan.angle_min + scan.angle_increment * chosen.astype(np.float64)
        valid = picked >= max(nearest, 1e-6)
        if any(scan.sensor_tilt):
            horizontal = directions(scan)[chosen]
            angles = np.arctan2(horizontal[:, 1], horizontal[:, 0]) - scan.sensor_pose[2]
            picked = np.where(picked < farthest, picked * np.hypot(*horizontal.T), picked)
        return cls(picked[valid], angles[valid], float(farthest), np.array(scan.sensor_pose, dtype=np.float64))


class SensorModel(ABC):
    """Sensor model: weights poses by a scan."""

    @abstractmethod
    def likelihoods(self, particles: Array, beams: Beams, world: LikelihoodMap) -> Array:
        """Return the likelihoods of poses.

        Parameters
        ----------
        particles : ndarray, shape (n, 3)
            Poses (x, y, yaw) of the base in the map's frame.
        beams : Beams
            The scan.
        world : LikelihoodMap
            The map.

        Returns
        -------
        ndarray, shape (n,)
            How likely the scan is at each pose, up to one factor for all.
        """
