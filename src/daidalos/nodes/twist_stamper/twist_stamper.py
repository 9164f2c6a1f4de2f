"""`twist_stamper`: publishes velocities with their time of reception."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from geometry_msgs.msg import Twist, TwistStamped
from rclpy.node import Node

from daidalos.common.parameters import Parameters, parameter
from daidalos.nodes.parameters import declare


@dataclass(frozen=True)
class TwistStamperParameters(Parameters):
    """Parameters of ``twist_stamper``."""

    frame_id: str = parameter("", "Frame of the stamped velocities.")


class TwistStamper(Node):
    """Node that publishes ``cmd_vel_out`` from ``cmd_vel_in``."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("twist_stamper", **kwargs)
        self._frame = declare(self, TwistStamperParameters).frame_id
        self._commands = self.create_publisher(TwistStamped, "cmd_vel_out", 10)
        self.create_subscription(Twist, "cmd_vel_in", self._stamp, 10)

    def _stamp(self, twist: Twist) -> None:
        message = TwistStamped(twist=twist)
        message.header.stamp = self.get_clock().now().to_msg()
        message.header.frame_id = self._frame
        self._commands.publish(message)
