"""Observations: rays of scans and point clouds in the frame of a costmap."""

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.pose2 import transform_points
from daidalos.mapping.scan import LaserScanData

_FAR = 1e3
"""Length [m] of rays that met nothing and have no largest range."""


@dataclass(frozen=True)
class CloudData:
    """Point cloud of a sensor.

    Attributes
    ----------
    points : ndarray, shape (n, 3)
        Positions [m] in the frame of the base.
    sensor : ndarray, shape (3,)
        Position [m] of the sensor in that frame.
    rotation : ndarray, shape (3, 3)
        Axes of the sensor's frame in that frame, as columns.
    """

    points: Array
    sensor: Array
    rotation: Array = field(default_factory=lambda: np.eye(3))

    def lifted(self, height: float) -> "CloudData":
        """Return the cloud of a sensor that is higher by so much [m]."""
        up = np.array([0.0, 0.0, height])
        return CloudData(self.points + up, self.sensor + up, self.rotation)


@dataclass(frozen=True)
class RangeData:
    """Measurement of a sonar or an infrared sensor.

    Attributes
    ----------
    range : float
        Distance [m] of the nearest thing in its cone; infinite and minus infinite for nothing and something where the
        sensor measures no distance.
    min_range, max_range : float
        What it can measure [m].
    field_of_view : float
        Whole angle [rad] of its cone.
    sensor_pose : ndarray, shape (3,)
        Pose (x, y, yaw) of the sensor in the frame of the base; it looks along x.
    """

    range: float
    min_range: float
    max_range: float
    field_of_view: float
    sensor_pose: Array

    def lifted(self, height: float) -> "RangeData":
        """Return the same measurement: it says nothing of heights."""
        return self


@dataclass(frozen=True)
class Observation:
    """Rays of one sensor measurement in the costmap's frame.

    Attributes
    ----------
    origin : ndarray, shape (2,)
        Where the rays start [m].
    ends : ndarray, shape (n, 2)
        Where they end [m].
    hits : ndarray of bool, shape (n,)
        Whether an obstacle ended them.
    stamp : float
        Time [s] of the reading.
    origin_height : float
        Height [m] at which the rays start.
    heights : ndarray, shape (n,), or None
        Heights [m] at which they end; the same where it is None.
    """

    origin: Array
    ends: Array
    hits: NDArray[np.bool_]
    stamp: float
    origin_height: float = 0.0
    heights: Array | None = None

    @property
    def end_heights(self) -> Array:
        """Heights [m] at which the rays end; shape (n,)."""
        return np.full(self.ends.shape[0], self.origin_height) if self.heights is None else self.heights

    @classmethod
    def from_scan(
        cls, scan: LaserScanData, base_pose: Array, stamp: float, *, inf_is_valid: bool = True
    ) -> "Observation":
        """Return the rays of a laser scan with the robot's base at a pose (x, y, yaw) in the costmap's frame.

        Ranges that are not a number, or outside of the sensor's limits, are left out; those that are infinite
        are rays that end at the sensor's largest range without a hit.
        """
        ranges = np.asarray(scan.ranges, dtype=np.float64)
        hits = np.isfinite(ranges) & (ranges >= scan.range_min) & (ranges <= scan.range_max)
        hits &= ranges > 0.0
        misses = np.isposinf(ranges) if inf_is_valid else np.zeros_like(hits)
        used = hits | misses
        length = np.where(misses, scan.range_max if math.isfinite(scan.range_max) else _FAR, ranges)[used]
        angle = scan.angle_min + scan.angle_increment * np.flatnonzero(used)
        x, y, yaw = scan.sensor_pose
        along, across, up = _tilted(np.cos(angle), np.sin(angle), *scan.sensor_tilt)
        ends = transform_points(np.array([x, y, yaw]), length[:, None] * np.stack([along, across], axis=-1))
        return cls(
            transform_points(base_pose, np.array([[x, y]]))[0],
            transform_points(base_pose, ends),
            hits[used],
            stamp,
            scan.sensor_height,
            scan.sensor_height + length * up,
        )

    @classmethod
    def from_cloud(cls, cloud: CloudData, base_pose: Array, stamp: float) -> "Observation":
        """Return the rays of a point cloud with the robot's base at a pose (x, y, yaw) in the costmap's frame.

        Points that are not finite are left out.
        """
        points = cloud.points[np.isfinite(cloud.points).all(axis=1)]
        return cls(
            transform_points(base_pose, cloud.sensor[None, :2])[0],
            transform_points(base_pose, points[:, :2]),
            np.ones(points.shape[0], np.bool_),
            stamp,
            float(cloud.sensor[2]),
            points[:, 2].copy(),
        )


def _tilted(x: Array, y: Array, roll: float, pitch: float) -> tuple[Array, Array, Array]:
    """Return directions in the plane of a sensor after its roll and pitch."""
    side, up = math.cos(roll) * y, math.sin(roll) * y
    return math.cos(pitch) * x + math.sin(pitch) * up, side, math.cos(pitch) * up - math.sin(pitch) * x
