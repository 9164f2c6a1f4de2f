"""`diff_drive_publisher`: drives the truck on an arc of 1 m radius: 0.1 m/s ahead, 0.1 rad/s to the left."""

from __future__ import annotations

from typing import Any

from rclpy.node import Node

_PERIOD = 0.1


class DiffDrivePublisher(Node):
    """Node that publishes ``/diff_drive_base_controller/cmd_vel``; parameters ``linear`` and ``angular``."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("diff_drive_publisher", **kwargs)
        from geometry_msgs.msg import TwistStamped

        self.declare_parameter("linear", 0.1)
        self.declare_parameter("angular", 0.1)
        self._publisher = self.create_publisher(TwistStamped, "/diff_drive_base_controller/cmd_vel", 10)
        self.create_timer(_PERIOD, self._send)

    def _send(self) -> None:
        from geometry_msgs.msg import TwistStamped

        message = TwistStamped()
        message.header.stamp = self.get_clock().now().to_msg()
        message.header.frame_id = "body"
        message.twist.linear.x = float(self.get_parameter("linear").value)
        message.twist.angular.z = float(self.get_parameter("angular").value)
        self._publisher.publish(message)
