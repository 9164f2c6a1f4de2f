"""`mimic`: makes one turtle move as another does."""

from __future__ import annotations

from typing import Any

from rclpy.node import Node


class Mimic(Node):
    """Node that publishes the velocity of ``input/pose`` as ``output/cmd_vel``."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("turtle_mimic", **kwargs)
        from geometry_msgs.msg import Twist
        from turtlesim.msg import Pose

        self._commands = self.create_publisher(Twist, "output/cmd_vel", 1)
        self.create_subscription(Pose, "input/pose", self._on_pose, 1)

    def _on_pose(self, pose: Any) -> None:
        from geometry_msgs.msg import Twist, Vector3

        self._commands.publish(Twist(linear=Vector3(x=pose.linear_velocity), angular=Vector3(z=pose.angular_velocity)))
