"""Clouds as scans, and scans as clouds."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import rclpy
from geometry_msgs.msg import TransformStamped
from hypothesis import given
from hypothesis import strategies as st
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan, PointCloud2
from sensor_msgs_py.point_cloud2 import create_cloud_xyz32, read_points_numpy
from std_msgs.msg import Header
from tf2_ros import StaticTransformBroadcaster

from daidalos.common.errors import UserError
from daidalos.nodes.pointcloud_to_laserscan._scan import Slice
from daidalos.nodes.pointcloud_to_laserscan.laserscan_to_pointcloud_node import LaserScanToPointCloud
from daidalos.nodes.pointcloud_to_laserscan.pointcloud_to_laserscan_node import PointCloudToLaserScan

coordinates = st.floats(-5.0, 5.0, width=32) | st.just(math.nan)


@given(st.lists(st.tuples(coordinates, coordinates, coordinates), max_size=40))
def test_each_ray_has_the_nearest_point_of_its_sector(points: list[tuple[float, float, float]]) -> None:
    cut = Slice(-0.5, 1.0, -2.0, 2.5, 0.25, 0.3, 4.0, empty=9.0)
    expected = [9.0] * 18
    for x, y, z in points:
        distance, angle = math.hypot(x, y), math.atan2(y, x)
        if -0.5 <= z <= 1.0 and 0.3 <= distance <= 4.0 and -2.0 <= angle <= 2.5:
            ray = int((angle + 2.0) / 0.25)
            if ray < 18:
                expected[ray] = min(expected[ray], distance)
    assert cut.count == 18
    assert cut.ranges(np.array(points, dtype=np.float32).reshape(-1, 3)) == pytest.approx(expected, rel=1e-6)


def result_of(node: Node, make: Callable[..., Node], source: str, message: Any, topic: str, kind: type[Any]) -> Any:
    """Return what a node makes of a message."""
    received: list[Any] = []
    publisher = node.create_publisher(type(message), source, qos_profile_sensor_data)
    node.create_subscription(kind, topic, received.append, qos_profile_sensor_data)
    tested = make()
    publisher.publish(message)
    rclpy.spin_once(tested, timeout_sec=5.0)
    rclpy.spin_once(node, timeout_sec=5.0)
    tested.destroy_node()
    return received[0]


def cloud(*points: tuple[float, float, float], frame: str = "lidar") -> PointCloud2:
    return create_cloud_xyz32(Header(frame_id=frame), points)


def overrides(**values: Any) -> list[Parameter]:
    return [Parameter(name, value=value) for name, value in values.items()]


def test_a_cloud_becomes_a_scan(node: Node) -> None:
    message = cloud((2.0, 0.0, 0.5), (1.0, 0.0, 0.5), (0.0, 3.0, 0.5), (0.5, 0.0, -1.0))
    result = result_of(node, PointCloudToLaserScan, "cloud_in", message, "scan", LaserScan)
    assert result.header.frame_id == "lidar"
    assert len(result.ranges) == 360
    assert (result.ranges[180], result.ranges[270]) == (1.0, 3.0)
    assert sum(math.isfinite(value) for value in result.ranges) == 2


def test_a_cloud_is_brought_into_a_frame(node: Node) -> None:
    lift = TransformStamped(header=Header(frame_id="base"), child_frame_id="lidar")
    lift.transform.translation.z, lift.transform.rotation.w = 1.0, 1.0
    StaticTransformBroadcaster(node).sendTransform(lift)

    def make() -> Node:
        settings = overrides(target_frame="base", transform_tolerance=5.0, min_height=0.4, max_height=0.6)
        return PointCloudToLaserScan(parameter_overrides=settings)

    message = cloud((2.0, 0.0, -0.5), (1.0, 0.0, 0.5))
    result = result_of(node, make, "cloud_in", message, "scan", LaserScan)
    assert (result.header.frame_id, result.ranges[180]) == ("base", 2.0)


def test_a_scan_becomes_a_cloud(node: Node) -> None:
    message = LaserScan(angle_increment=math.pi / 2, range_max=5.0, ranges=[1.0, 2.0, 9.0])
    result = result_of(node, LaserScanToPointCloud, "scan_in", message, "cloud", PointCloud2)
    assert read_points_numpy(result, ["x", "y", "z"]) == pytest.approx(np.array([[1, 0, 0], [0, 2, 0]]), abs=1e-6)


@pytest.mark.usefixtures("graph")
def test_rays_that_make_no_sense() -> None:
    with pytest.raises(UserError, match=r"'angle_increment' of .* must be above 0, got 0"):
        PointCloudToLaserScan(parameter_overrides=overrides(angle_increment=0.0))
