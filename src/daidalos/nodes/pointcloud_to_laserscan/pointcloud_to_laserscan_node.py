"""`pointcloud_to_laserscan_node`: publishes the nearest points of clouds as laser scans."""

from __future__ import annotations

import math
import sys
from typing import Any

from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan, PointCloud2
from sensor_msgs_py.point_cloud2 import read_points_numpy

from daidalos.nodes.pointcloud_to_laserscan._frames import Frames
from daidalos.nodes.pointcloud_to_laserscan._scan import Slice
from daidalos.nodes.runner import run

_LARGEST = 3.4028234663852886e38
"""Largest number of a 32-bit float."""


class PointCloudToLaserScan(Node):
    """Node that publishes ``scan`` from ``cloud_in`` while it has subscribers.

    Parameters of the node: ``target_frame`` (of the scan; that of the cloud if empty), ``transform_tolerance`` [s],
    ``min_height``, ``max_height`` [m], ``angle_min``, ``angle_max``, ``angle_increment`` [rad], ``range_min``,
    ``range_max`` [m], ``scan_time`` [s], ``use_inf`` (whether rays without a point are infinite) and ``inf_epsilon``
    (how far beyond the maximum they are else [m]).
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("pointcloud_to_laserscan", **kwargs)
        self._frames = Frames(self)
        range_max = self._number("range_max", sys.float_info.max)
        use_inf = bool(self.declare_parameter("use_inf", True).value)
        inf_epsilon = self._number("inf_epsilon", 1.0)
        self._slice = Slice(
            min_height=self._number("min_height", sys.float_info.min),
            max_height=self._number("max_height", sys.float_info.max),
            angle_min=self._number("angle_min", -math.pi),
            angle_max=self._number("angle_max", math.pi),
            angle_increment=self._number("angle_increment", math.pi / 180),
            range_min=self._number("range_min", 0.0),
            range_max=range_max,
            empty=math.inf if use_inf else range_max + inf_epsilon,
        )
        if self._slice.angle_increment <= 0 or self._slice.angle_max <= self._slice.angle_min:
            raise RuntimeError(
                "the parameters 'angle_min', 'angle_max' and 'angle_increment' give no rays: "
                f"{self._slice.angle_min}, {self._slice.angle_max}, {self._slice.angle_increment}"
            )
        self._scan_time = self._number("scan_time", 1.0 / 30.0)
        self._scans = self.create_publisher(LaserScan, "scan", qos_profile_sensor_data)
        self.create_subscription(PointCloud2, "cloud_in", self._publish_scan, qos_profile_sensor_data)

    def _number(self, name: str, default: float) -> float:
        return float(self.declare_parameter(name, default).value)

    def _publish_scan(self, cloud: PointCloud2) -> None:
        if self._scans.get_subscription_count() == 0:
            return
        transformed = self._frames.transform_cloud(cloud)
        if transformed is None:
            return
        points = read_points_numpy(transformed, ["x", "y", "z"])
        cut = self._slice
        self._scans.publish(
            LaserScan(
                header=transformed.header,
                angle_min=cut.angle_min,
                angle_max=cut.angle_max,
                angle_increment=cut.angle_increment,
                scan_time=self._scan_time,
                range_min=cut.range_min,
                range_max=min(cut.range_max, _LARGEST),
                ranges=cut.ranges(points.reshape(-1, 3)),
            )
        )


def main() -> int:
    """Run the node."""
    return run(PointCloudToLaserScan)
