"""`laserscan_to_pointcloud_node`: publishes scans as point clouds."""

from __future__ import annotations

from typing import Any

from laser_geometry import LaserProjection
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan, PointCloud2

from daidalos.nodes.pointcloud_to_laserscan._frames import Frames
from daidalos.nodes.runner import run


class LaserScanToPointCloud(Node):
    """Node that publishes ``cloud`` from ``scan_in`` while it has subscribers."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("laserscan_to_pointcloud", **kwargs)
        self._frames = Frames(self)
        self._projection = LaserProjection()
        self._clouds = self.create_publisher(PointCloud2, "cloud", qos_profile_sensor_data)
        self.create_subscription(LaserScan, "scan_in", self._publish_cloud, qos_profile_sensor_data)

    def _publish_cloud(self, scan: LaserScan) -> None:
        if self._clouds.get_subscription_count() == 0:
            return
        cloud = self._frames.transform_cloud(self._projection.projectLaser(scan))
        if cloud is not None:
            self._clouds.publish(cloud)


def main() -> int:
    """Run the node."""
    return run(LaserScanToPointCloud)
