"""`turtle_tf2_broadcaster`: publishes the pose of a turtle as a transform from ``world``."""

from __future__ import annotations

from typing import Any

from rclpy.node import Node

from daidalos.nodes.turtle_tf2_py._transforms import transform


class TurtleTf2Broadcaster(Node):
    """Node that publishes the pose of the turtle of the parameter ``turtlename`` as a transform."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("turtle_tf2_frame_publisher", **kwargs)
        from tf2_ros import TransformBroadcaster
        from turtlesim.msg import Pose

        self._name = str(self.declare_parameter("turtlename", "turtle").value)
        self._broadcaster = TransformBroadcaster(self)
        self.create_subscription(Pose, f"/{self._name}/pose", self._on_pose, 1)

    def _on_pose(self, pose: Any) -> None:
        stamp = self.get_clock().now().to_msg()
        self._broadcaster.sendTransform(
            transform(stamp, "world", self._name, (pose.x, pose.y, 0.0), (0.0, 0.0, pose.theta))
        )
