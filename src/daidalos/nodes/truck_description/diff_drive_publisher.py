"""`diff_drive_publisher`: drives the truck on an arc of 1 m radius: 0.1 m/s ahead, 0.1 rad/s to the left."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from rclpy.node import Node

from daidalos.common.parameters import Parameters, parameter
from daidalos.nodes.parameters import declare

_PERIOD = 0.1


@dataclass(frozen=True)
class DiffDrivePublisherParameters(Parameters):
    """Parameters of ``diff_drive_publisher``."""

    linear: float = parameter(0.1, "Velocity ahead.", unit="m/s")
    angular: float = parameter(0.1, "Angular velocity to the left.", unit="rad/s")


class DiffDrivePublisher(Node):
    """Node that publishes ``/diff_drive_base_controller/cmd_vel``."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("diff_drive_publisher", **kwargs)
        from geometry_msgs.msg import TwistStamped

        self._settings = declare(self, DiffDrivePublisherParameters, reconfigure=self._reconfigure)
        self._publisher = self.create_publisher(TwistStamped, "/diff_drive_base_controller/cmd_vel", 10)
        self.create_timer(_PERIOD, self._send)

    def _reconfigure(self, parameters: DiffDrivePublisherParameters) -> None:
        self._settings = parameters

    def _send(self) -> None:
        from geometry_msgs.msg import TwistStamped

        message = TwistStamped()
        message.header.stamp = self.get_clock().now().to_msg()
        message.header.frame_id = "body"
        message.twist.linear.x = self._settings.linear
        message.twist.angular.z = self._settings.angular
        self._publisher.publish(message)
