"""`state_publisher`: moves the robot and its joints, to demonstrate joint states and transforms."""

from __future__ import annotations

import math
from typing import Any

from rclpy.node import Node

_PERIOD = 1 / 30
_DEGREE = math.pi / 180


class StatePublisher(Node):
    """Node that publishes ``joint_states`` and the transform from ``odom`` to ``axis`` at 30 Hz."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("state_publisher", **kwargs)
        from sensor_msgs.msg import JointState
        from tf2_ros import TransformBroadcaster

        self._publisher = self.create_publisher(JointState, "joint_states", 10)
        self._broadcaster = TransformBroadcaster(self)
        self._tilt, self._tilt_step = 0.0, _DEGREE
        self._swivel = self._angle = 0.0
        self._height, self._height_step = 0.0, 0.005
        self.create_timer(_PERIOD, self._move)

    def _move(self) -> None:
        from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
        from sensor_msgs.msg import JointState
        from std_msgs.msg import Header

        stamp = self.get_clock().now().to_msg()
        self._publisher.publish(
            JointState(
                header=Header(stamp=stamp),
                name=["swivel", "tilt", "periscope"],
                position=[self._swivel, self._tilt, self._height],
            )
        )
        # Ahead is across the circle's radius.
        half = self._angle / 2 + math.pi / 4
        self._broadcaster.sendTransform(
            TransformStamped(
                header=Header(stamp=stamp, frame_id="odom"),
                child_frame_id="axis",
                transform=Transform(
                    translation=Vector3(x=2 * math.cos(self._angle), y=2 * math.sin(self._angle), z=0.7),
                    rotation=Quaternion(x=0.0, y=0.0, z=math.sin(half), w=math.cos(half)),
                ),
            )
        )
        self._advance()

    def _advance(self) -> None:
        """Tilt and raise to and fro, turn the head and walk on."""
        self._tilt += self._tilt_step
        if not -0.5 <= self._tilt <= 0.0:
            self._tilt_step = -self._tilt_step
            self._tilt = min(max(self._tilt, -0.5), 0.0)
        self._height += self._height_step
        if not -0.15 <= self._height <= 0.0:
            self._height_step = -self._height_step
            self._height = min(max(self._height, -0.15), 0.0)
        self._swivel += _DEGREE
        self._angle += _DEGREE / 4
