"""The simulator without physics, beside the test as navigator."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from geometry_msgs.msg import PoseWithCovarianceStamped, Twist
from nav_msgs.msg import Odometry
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan

from daidalos.nodes.conversions import grid_message, pose2_of, pose_message, transform_stamped, twist_message
from daidalos.nodes.nav2_loopback_sim.loopback_simulator import LoopbackSimulator
from nodes.stepped import LATCHED, Stage

pytestmark = pytest.mark.timeout(300)


def place(stage: Stage, *pose: float) -> None:
    message = PoseWithCovarianceStamped()
    message.pose.pose = pose_message(pose)
    stage.publish("/initialpose", message)


@pytest.mark.slow
def test_the_robot_obeys_is_moved_and_sees_the_map(stage: Callable[[dict[str, Any]], Stage]) -> None:
    from tf2_msgs.msg import TFMessage

    it = stage({"/loopback_simulator": {"publish_clock": False, "update_duration": 0.05, "scan_range_max": 5.0}})
    it.add(LoopbackSimulator())
    odometry, scans = it.collect(Odometry, "/odom"), it.collect(LaserScan, "/scan", qos_profile_sensor_data)
    transforms = it.collect(TFMessage, "/tf")
    mount = transform_stamped((0.1, 0.0, 0.0), "base_footprint", "base_scan", it.stamp)
    it.publish("/tf_static", TFMessage(transforms=[mount]), LATCHED)
    cells = np.zeros((100, 100), np.int8)
    cells[:, 80] = 100  # at x = 3
    it.publish("/map", grid_message(cells, 0.05, (-1.0, -2.5), "map", it.stamp), LATCHED)
    commands = it.node.create_publisher(Twist, "/cmd_vel", 1)

    def drive() -> bool:
        commands.publish(twist_message((0.5, 0.0, 0.0), None, it.stamp))
        return bool(odometry) and odometry[-1].pose.pose.position.x > 0.5

    for _ in range(20):
        drive()
        it.step()
    assert odometry[-1].pose.pose.position.x == 0.0  # nobody has said where the robot is
    assert np.isinf(scans[-1].ranges).all()
    place(it, 1.0, 0.0, 0.0)
    it.step_until(drive)
    it.step_until(lambda: np.isfinite(scans[-1].ranges).any())
    ahead = scans[-1].ranges[round(np.pi / scans[-1].angle_increment)]
    x = 1.0 + odometry[-1].pose.pose.position.x
    assert ahead == pytest.approx(3.0 - x - 0.1, abs=0.15)
    it.step_for(1.5)
    before = pose2_of(odometry[-1].pose.pose)
    it.step_for(0.5)
    assert pose2_of(odometry[-1].pose.pose) == pytest.approx(before)  # commands stopped
    place(it, -0.5, 1.0, 1.0)
    it.step_for(0.2)
    assert pose2_of(odometry[-1].pose.pose) == pytest.approx(before)
    (localized,) = [one for one in transforms[-1].transforms if one.header.frame_id == "map"]
    assert localized.child_frame_id == "odom"
    it.publish("/cmd_vel", twist_message((float("nan"), 0.0, 0.0), None, it.stamp))
    it.step_for(0.2)
    assert pose2_of(odometry[-1].pose.pose) == pytest.approx(before)
    # Maps that say what they are not do not replace the one before, and end nothing.
    for odd in ({"resolution": float("nan")}, {"resolution": 0.0}, {"resolution": -1.0}, {"width": 4294967295}):
        message = grid_message(cells, 0.05, (-1.0, -2.5), "map", it.stamp)
        for name, value in odd.items():
            setattr(message.info, name, value)
        it.publish("/map", message, LATCHED)
        it.step_for(0.3)
    assert np.isfinite(scans[-1].ranges).any()
