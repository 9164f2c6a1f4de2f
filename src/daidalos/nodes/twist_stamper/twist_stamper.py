"""`twist_stamper`: publishes velocities with their time of reception."""

from __future__ import annotations

import sys
from typing import Any

from geometry_msgs.msg import Twist, TwistStamped
from rclpy.node import Node

from daidalos.nodes.runner import run


class TwistStamper(Node):
    """Node that publishes ``cmd_vel_out`` from ``cmd_vel_in``; parameter: ``frame_id``."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("twist_stamper", **kwargs)
        self._frame = str(self.declare_parameter("frame_id", "").value)
        self._commands = self.create_publisher(TwistStamped, "cmd_vel_out", 10)
        self.create_subscription(Twist, "cmd_vel_in", self._stamp, 10)

    def _stamp(self, twist: Twist) -> None:
        message = TwistStamped(twist=twist)
        message.header.stamp = self.get_clock().now().to_msg()
        message.header.frame_id = self._frame
        self._commands.publish(message)


def main() -> int:
    """Run the node."""
    return run(TwistStamper)


if __name__ == "__main__":
    sys.exit(main())
