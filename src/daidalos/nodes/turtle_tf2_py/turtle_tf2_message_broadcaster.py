"""`turtle_tf2_message_broadcaster`: spawns ``turtle3``, drives it, and publishes it as points in ``world``."""

from __future__ import annotations

from typing import Any

from rclpy.node import Node

_NAME = "turtle3"


class TurtleTf2MessageBroadcaster(Node):
    """Node that publishes ``turtle3/turtle_point_stamped``, as a sensor of the turtle's position would."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("turtle_tf2_message_broadcaster", **kwargs)
        from geometry_msgs.msg import PointStamped, Twist
        from turtlesim.msg import Pose
        from turtlesim.srv import Spawn

        self._spawner = self.create_client(Spawn, "spawn")
        self._spawning: Any = None
        self._commands = self.create_publisher(Twist, f"{_NAME}/cmd_vel", 10)
        self._points = self.create_publisher(PointStamped, f"{_NAME}/turtle_point_stamped", 10)
        self.create_subscription(Pose, f"{_NAME}/pose", self._on_pose, 10)
        self.create_timer(1.0, self._on_timer)

    def _on_timer(self) -> None:
        from turtlesim.srv import Spawn

        if self._spawning is not None:
            return
        if self._spawner.service_is_ready():
            self._spawning = self._spawner.call_async(Spawn.Request(name=_NAME, x=4.0, y=2.0, theta=0.0))
            self._spawning.add_done_callback(
                lambda answer: self.get_logger().info(f"Successfully spawned {answer.result().name or _NAME}")
            )
        else:
            self.get_logger().info("Service is not ready")

    def _on_pose(self, pose: Any) -> None:
        from geometry_msgs.msg import Point, PointStamped, Twist, Vector3
        from std_msgs.msg import Header

        self._commands.publish(Twist(linear=Vector3(x=1.0), angular=Vector3(z=1.0)))
        header = Header(stamp=self.get_clock().now().to_msg(), frame_id="world")
        self._points.publish(PointStamped(header=header, point=Point(x=pose.x, y=pose.y)))
