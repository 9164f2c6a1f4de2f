"""`twist_unstamper`: publishes stamped velocities without their stamps."""

from __future__ import annotations

from typing import Any

from geometry_msgs.msg import Twist, TwistStamped
from rclpy.node import Node


class TwistUnstamper(Node):
    """Node that publishes ``cmd_vel_out`` from ``cmd_vel_in``."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("twist_unstamper", **kwargs)
        commands = self.create_publisher(Twist, "cmd_vel_out", 10)
        self.create_subscription(TwistStamped, "cmd_vel_in", lambda message: commands.publish(message.twist), 10)
