"""`turtle_tf2_listener`: spawns ``turtle2`` and makes it follow a frame."""

from __future__ import annotations

import math
from typing import Any

from rclpy.node import Node
from rclpy.time import Time

_NAME = "turtle2"
_TURNING, _DRIVING = 1.0, 0.5  # speeds for an angle of 1 rad and a distance of 1 unit


class TurtleTf2Listener(Node):
    """Node that drives ``turtle2`` towards the frame of the parameter ``target_frame``."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("turtle_tf2_frame_listener", **kwargs)
        from geometry_msgs.msg import Twist
        from tf2_ros import Buffer, TransformListener
        from turtlesim.srv import Spawn

        self._target = str(self.declare_parameter("target_frame", "turtle1").value)
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)
        self._spawner = self.create_client(Spawn, "spawn")
        self._spawning: Any = None
        self._is_spawned = False
        self._commands = self.create_publisher(Twist, f"{_NAME}/cmd_vel", 1)
        self.create_timer(1.0, self._on_timer)

    def _on_timer(self) -> None:
        if self._is_spawned:
            self._follow()
        elif self._spawning is None:
            self._spawn()
        elif self._spawning.done():
            self.get_logger().info(f"Successfully spawned {self._spawning.result().name or _NAME}")
            self._is_spawned = True
        else:
            self.get_logger().info("Spawn is not finished")

    def _spawn(self) -> None:
        from turtlesim.srv import Spawn

        if self._spawner.service_is_ready():
            self._spawning = self._spawner.call_async(Spawn.Request(name=_NAME, x=4.0, y=2.0, theta=0.0))
        else:
            self.get_logger().info("Service is not ready")

    def _follow(self) -> None:
        from geometry_msgs.msg import Twist, Vector3
        from tf2_ros import TransformException

        try:
            found = self._buffer.lookup_transform(_NAME, self._target, Time())
        except TransformException as error:
            self.get_logger().info(f"Could not transform {_NAME} to {self._target}: {error}")
            return
        x, y = found.transform.translation.x, found.transform.translation.y
        self._commands.publish(
            Twist(linear=Vector3(x=_DRIVING * math.hypot(x, y)), angular=Vector3(z=_TURNING * math.atan2(y, x)))
        )
