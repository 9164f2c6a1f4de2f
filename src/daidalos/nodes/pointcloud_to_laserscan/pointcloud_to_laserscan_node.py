"""`pointcloud_to_laserscan_node`: publishes the nearest points of clouds as laser scans."""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass
from typing import Any

from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan, PointCloud2
from sensor_msgs_py.point_cloud2 import read_points_numpy

from daidalos.common.parameters import ParameterError, Parameters, parameter
from daidalos.nodes.parameters import declare
from daidalos.nodes.pointcloud_to_laserscan._frames import Frames
from daidalos.nodes.pointcloud_to_laserscan._scan import Slice
from daidalos.nodes.runner import run

_LARGEST = 3.4028234663852886e38
"""Largest number of a 32-bit float."""


@dataclass(frozen=True)
class PointCloudToLaserScanParameters(Parameters):
    """Parameters of ``pointcloud_to_laserscan_node``, beside those of all nodes that transform clouds."""

    min_height: float = parameter(sys.float_info.min, "Least height of points.", unit="m")
    max_height: float = parameter(sys.float_info.max, "Greatest height of points.", unit="m")
    angle_min: float = parameter(-math.pi, "Direction of the first ray.", unit="rad")
    angle_max: float = parameter(math.pi, "Direction of the last ray.", unit="rad")
    angle_increment: float = parameter(math.pi / 180, "Angle between rays.", unit="rad", above=0.0)
    range_min: float = parameter(0.0, "Least distance of points.", unit="m", minimum=0.0)
    range_max: float = parameter(sys.float_info.max, "Greatest distance of points.", unit="m", minimum=0.0)
    scan_time: float = parameter(1.0 / 30.0, "Time between scans, as the messages say it.", unit="s", minimum=0.0)
    use_inf: bool = parameter(True, "Whether the range of rays without a point is infinite.")
    inf_epsilon: float = parameter(
        1.0, "How far the range of other rays without a point exceeds 'range_max'.", unit="m"
    )

    def check(self) -> None:
        """Refuse angles without rays."""
        if self.angle_max <= self.angle_min:
            raise ParameterError("angle_max", f"must be above 'angle_min', {self.angle_min:g}, got {self.angle_max:g}")


class PointCloudToLaserScan(Node):
    """Node that publishes ``scan`` from ``cloud_in`` while it has subscribers."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("pointcloud_to_laserscan", **kwargs)
        self._frames = Frames(self)
        p = declare(self, PointCloudToLaserScanParameters)
        self._slice = Slice(
            p.min_height,
            p.max_height,
            p.angle_min,
            p.angle_max,
            p.angle_increment,
            p.range_min,
            p.range_max,
            math.inf if p.use_inf else p.range_max + p.inf_epsilon,
        )
        self._scan_time = p.scan_time
        self._scans = self.create_publisher(LaserScan, "scan", qos_profile_sensor_data)
        self.create_subscription(PointCloud2, "cloud_in", self._publish_scan, qos_profile_sensor_data)

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
