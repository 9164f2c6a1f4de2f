"""Depth images as scans."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import rclpy
from cv_bridge import CvBridge
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import CameraInfo, Image, LaserScan
from std_msgs.msg import Header

from daidalos.common.errors import UserError
from daidalos.nodes.depthimage_to_laserscan._scan import scan
from daidalos.nodes.depthimage_to_laserscan.depthimage_to_laserscan_node import DepthImageToLaserScan

FX, CX, WIDTH = 100.0, 79.5, 160


def test_a_wall_ahead_is_a_straight_line() -> None:
    fan = scan(np.full((120, WIDTH), 2.0), FX, CX, 0.3, 10.0, 5)
    angles = fan.angle_min + fan.angle_increment * np.arange(WIDTH)
    assert fan.angle_max == pytest.approx(math.atan(CX / FX))
    seen = np.isfinite(fan.ranges)
    # Columns are not evenly spaced in angle: some rays get none, and none is further off than half a ray.
    assert seen.sum() > 0.8 * WIDTH
    assert (fan.ranges * np.cos(angles))[seen] == pytest.approx(2.0, abs=2.0 * abs(fan.angle_increment))


def test_what_counts() -> None:
    depth = np.full((9, WIDTH), 3.0)
    depth[4, 80], depth[5, 80], depth[0, 80] = 1.0, 1.5, 0.5
    depth[:, 20], depth[:, 140], depth[:, 100] = math.nan, 50.0, 0.1
    middle, left, right, close = (
        round(
            (-math.atan((column - CX) / FX) - math.atan((CX - WIDTH + 1) / FX)) / (2 * math.atan(CX / FX)) * (WIDTH - 1)
        )
        for column in (80, 20, 140, 100)
    )
    one, three = (scan(depth, FX, CX, 0.3, 10.0, rows).ranges for rows in (1, 3))
    assert one[middle] == three[middle] == pytest.approx(1.0, rel=1e-3)
    assert math.isnan(one[left])
    assert math.isinf(one[right])
    assert math.isnan(one[close])


@pytest.mark.parametrize(("kind", "metres"), [(np.uint16, 0.001), (np.float32, 1.0)])
def test_the_node(node: Node, kind: type[Any], metres: float) -> None:
    received: list[LaserScan] = []
    node.create_subscription(LaserScan, "scan", received.append, qos_profile_sensor_data)
    cameras = node.create_publisher(CameraInfo, "depth_camera_info", qos_profile_sensor_data)
    images = node.create_publisher(Image, "depth", qos_profile_sensor_data)
    tested = DepthImageToLaserScan(parameter_overrides=[Parameter("output_frame", value="camera_link")])
    info = CameraInfo(k=[FX, 0.0, CX, 0.0, FX, 59.5, 0.0, 0.0, 1.0])
    pixels = np.full((120, WIDTH), round(2.0 / metres), dtype=kind)
    cameras.publish(info)
    images.publish(CvBridge().cv2_to_imgmsg(pixels, header=Header(frame_id="optical")))
    for _ in range(2):
        rclpy.spin_once(tested, timeout_sec=5.0)
    rclpy.spin_once(node, timeout_sec=5.0)
    assert received[0].header.frame_id == "camera_link"
    assert received[0].ranges[WIDTH // 2] == pytest.approx(2.0, abs=0.02)
    assert (received[0].range_min, received[0].range_max) == pytest.approx((0.45, 10.0))


@pytest.mark.usefixtures("graph")
def test_what_cannot_be_a_scan() -> None:
    with pytest.raises(UserError, match=r"'scan_height' of .* must be at least 1, got 0"):
        DepthImageToLaserScan(parameter_overrides=[Parameter("scan_height", value=0)])
    tested = DepthImageToLaserScan(parameter_overrides=[Parameter("scan_height", value=9)])
    assert "encoded as 'rgb8'" in tested._fault(Image(encoding="rgb8"), CameraInfo())
    assert "not calibrated" in tested._fault(Image(encoding="32FC1"), CameraInfo())
    info = CameraInfo(k=[FX] * 9)
    assert "has only 4 rows" in tested._fault(Image(encoding="32FC1", height=4), info)
