"""`joint_publisher`: makes the humanoid curl its arms, one up while the other goes down."""

from __future__ import annotations

import math
from typing import Any

from rclpy.node import Node

_JOINTS = ["left_upper_to_lower_arm", "right_upper_to_lower_arm"]
_PERIOD = 0.1
_CURL = 4.0
"""Seconds from down to down."""

_TOP = 2.2


class JointPublisher(Node):
    """Node that sends a trajectory point at 10 Hz to ``/joint_trajectory_controller/joint_trajectory``."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("joint_publisher", **kwargs)
        from trajectory_msgs.msg import JointTrajectory

        topic = "/joint_trajectory_controller/joint_trajectory"
        self._publisher = self.create_publisher(JointTrajectory, topic, 10)
        self._count = 0
        self.create_timer(_PERIOD, self._send)

    def _send(self) -> None:
        from builtin_interfaces.msg import Duration
        from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

        self._count += 1
        phase = 2 * math.pi * self._count * _PERIOD / _CURL
        raised = [_TOP * (1 - math.cos(phase + shift)) / 2 for shift in (0.0, math.pi)]
        point = JointTrajectoryPoint(
            positions=raised, time_from_start=Duration(sec=0, nanosec=round(2 * _PERIOD * 1e9))
        )
        self._publisher.publish(JointTrajectory(joint_names=_JOINTS, points=[point]))
