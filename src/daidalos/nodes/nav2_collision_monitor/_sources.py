"""Sources of obstacle points: scans, clouds, ranges and polygons, in the frame of the robot's base."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rclpy.time import Time
from tf2_ros import Buffer, TransformException

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.common.pose3 import rotation_matrix
from daidalos.navigation.costmap.frozen_data import FrozenData
from daidalos.nodes.conversions import pose2_of_transform
from daidalos.samples.fields import nanoseconds

_OWN_RADIUS = 0.5
"""Distance [m] from a sensor up to which it may see the robot itself."""


@dataclass(frozen=True)
class SourceParameters(Parameters):
    """Parameters of a source, by their Nav2 names."""

    type: str = parameter(
        "scan", "Kind of the messages.", choices=("scan", "pointcloud", "range", "polygon"), read_only=True
    )
    topic: str = parameter("scan", "Topic of the messages.", not_empty=True, read_only=True)
    enabled: bool = parameter(True, "Whether the source is looked at.")
    source_timeout: float = parameter(
        math.nan, "Age of data that stops the robot; 0 for none, the node's where not set.", unit="s", minimum=0.0
    )
    min_height: float = parameter(0.05, "Least height of a cloud's points above the base.", unit="m")
    max_height: float = parameter(0.5, "Greatest height of a cloud's points above the base.", unit="m")
    min_range: float = parameter(0.0, "Least distance of a cloud's points from the sensor.", unit="m", minimum=0.0)
    obstacles_angle: float = parameter(
        math.pi / 180.0, "Angle between the points that stand for a range.", unit="rad", above=0.0
    )
    sampling_distance: float = parameter(0.1, "Distance of points on a polygon's edges.", unit="m", above=0.0)


class Source:
    """The newest message of a sensor.

    Parameters
    ----------
    node, buffer
        The node that listens, and its transforms.
    parameters : SourceParameters
    """

    def __init__(self, node: Node, buffer: Buffer, parameters: SourceParameters) -> None:
        from geometry_msgs.msg import PolygonInstanceStamped
        from sensor_msgs.msg import LaserScan, PointCloud2, Range

        self.parameters = parameters
        self._buffer = buffer
        self._message: Any = None
        self._judged: Any = None
        self._frozen = FrozenData(_OWN_RADIUS)
        self._is_frozen = False
        kinds = {"scan": LaserScan, "pointcloud": PointCloud2, "range": Range, "polygon": PolygonInstanceStamped}
        node.create_subscription(kinds[parameters.type], parameters.topic, self._take, qos_profile_sensor_data)

    def _take(self, message: Any) -> None:
        self._message = message

    def points(self, now_ns: int, timeout: float, base: str, odom: str, tolerance: float) -> Array | str:
        """Return the obstacle points (n, 2) in the base frame, or why they cannot be told.

        Parameters
        ----------
        now_ns : int
            Time [ns].
        timeout : float
            Age [s] that data may have; 0 for any.
        base, odom : str
            Frame of the base, and the fixed one over which its motion since the message is taken into account; that
            is left out where empty.
        tolerance : float
            Age [s] that transforms may have, and time by which stamps may be ahead.
        """
        if self._message is None:
            return "nothing was received"
        header = self._message.header
        age = 1e-9 * (now_ns - nanoseconds(header.stamp))
        if (timeout > 0.0 and age > timeout) or age < -max(tolerance, 0.01):
            return f"its data are {age:.2f} s old"
        points = self._points()
        if isinstance(points, str):
            return points
        try:
            if odom and self._repeats(points, base, odom):
                return "it repeats the same data while the robot moves"
            transform = self._transform(header, base, odom, now_ns, tolerance).transform
        except TransformException as error:
            return str(error)
        q, offset = transform.rotation, transform.translation
        moved = points @ rotation_matrix((q.x, q.y, q.z, q.w)).T + np.array([offset.x, offset.y, offset.z])
        if self.parameters.type == "pointcloud":
            height = moved[:, 2]
            moved = moved[(height >= self.parameters.min_height) & (height <= self.parameters.max_height)]
        flat: Array = moved[:, :2]
        return flat

    def _repeats(self, points: Array, base: str, odom: str) -> bool:
        """Return whether the scan or cloud is frozen; see `FrozenData`."""
        if self._judged is not self._message and self.parameters.type in ("scan", "pointcloud"):
            self._judged = self._message
            pose = pose2_of_transform(self._buffer.lookup_transform(odom, base, Time()).transform)
            self._is_frozen = self._frozen.repeats(points, np.linalg.norm(points, axis=1), pose)
        return self._is_frozen

    def _transform(self, header: Any, base: str, odom: str, now_ns: int, tolerance: float) -> Any:
        if not odom:
            return self._buffer.lookup_transform(base, header.frame_id, Time())
        newest = Time.from_msg(self._buffer.lookup_transform(odom, base, Time()).header.stamp)
        age = 1e-9 * (now_ns - newest.nanoseconds)
        if age > tolerance:
            raise TransformException(f"the transform from {odom} to {base} is {age:.2f} s old")
        stamp = min(Time.from_msg(header.stamp).nanoseconds, newest.nanoseconds)
        return self._buffer.lookup_transform_full(base, newest, header.frame_id, Time(nanoseconds=stamp), odom)

    def _points(self) -> Array | str:
        """Return the points (n, 3) in the frame of the message, or why it cannot be used."""
        return {
            "scan": self._scan_points,
            "pointcloud": self._cloud_points,
            "range": self._range_points,
            "polygon": self._polygon_points,
        }[self.parameters.type]()

    def _scan_points(self) -> Array | str:
        scan = self._message
        ranges = np.asarray(scan.ranges, dtype=float)
        if not len(ranges) or np.isnan(ranges).all():
            return "its scan has no ranges"
        angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
        seen = np.isfinite(ranges) & (ranges >= scan.range_min) & (ranges <= scan.range_max)
        return _around(ranges[seen], angles[seen])

    def _cloud_points(self) -> Array | str:
        from sensor_msgs_py.point_cloud2 import read_points_numpy

        points = read_points_numpy(self._message, ["x", "y", "z"]).reshape(-1, 3).astype(float)
        if len(points) and np.isnan(points).any(axis=1).all():
            return "its cloud has no finite point"
        points = points[np.isfinite(points).all(axis=1)]
        near: Array = points[np.linalg.norm(points, axis=1) >= self.parameters.min_range]
        return near

    def _range_points(self) -> Array | str:
        message = self._message
        if math.isnan(message.range):
            return "its range is not a number"
        if not message.min_range <= message.range <= message.max_range:
            return np.zeros((0, 3))
        half = 0.5 * message.field_of_view
        count = 1 + math.ceil(message.field_of_view / self.parameters.obstacles_angle)
        return _around(np.full(count, float(message.range)), np.linspace(-half, half, count))

    def _polygon_points(self) -> Array | str:
        corners = np.array([(one.x, one.y, one.z) for one in self._message.polygon.polygon.points], dtype=float)
        if not len(corners) or not np.isfinite(corners).all():
            return "its polygon has no finite corners"
        edges = zip(corners, np.roll(corners, -1, axis=0), strict=True)
        return np.concatenate([self._along(start, end) for start, end in edges])

    def _along(self, start: Array, end: Array) -> Array:
        count = 1 + math.ceil(float(np.linalg.norm(end - start)) / self.parameters.sampling_distance)
        points: Array = np.linspace(start, end, count)
        return points


def _around(ranges: Array, angles: Array) -> Array:
    return np.stack([ranges * np.cos(angles), ranges * np.sin(angles), np.zeros(len(ranges))], axis=-1)
