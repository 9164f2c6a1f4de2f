"""`draw_square`: drives a turtle along a square repeatedly."""

from __future__ import annotations

import math
from typing import Any

from rclpy.node import Node

from daidalos.nodes.turtlesim._turtle import UPDATE_S, normalized

_SIDE = 2.0
_SPEED = 1.0  # units/s
_TURNING_SPEED = 0.4  # rad/s
_NEAR = 0.1
_NEAR_ANGLE = 0.01
_STILL = 0.0001


class DrawSquare(Node):
    """Node that publishes ``turtle1/cmd_vel`` to drive along a square; calls ``reset`` first."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("draw_square", **kwargs)
        from geometry_msgs.msg import Twist
        from std_srvs.srv import Empty
        from turtlesim.msg import Pose

        self._pose: Any = None
        self._goal: tuple[float, float, float] | None = None
        self._turns = False
        self._is_reset = False
        self._called: Any = None
        self._commands = self.create_publisher(Twist, "turtle1/cmd_vel", 1)
        self._reset = self.create_client(Empty, "reset")
        self.create_subscription(Pose, "turtle1/pose", self._on_pose, 1)
        self.create_timer(UPDATE_S, self._on_timer)

    def _on_pose(self, pose: Any) -> None:
        self._pose = pose

    def _on_timer(self) -> None:
        if not self._is_reset:
            self._begin()
        elif self._pose is not None:
            self._drive(self._pose)

    def _begin(self) -> None:
        """Reset the drawing."""
        from std_srvs.srv import Empty

        if self._called is None and self._reset.service_is_ready():
            self._called = self._reset.call_async(Empty.Request())
        elif self._called is not None and self._called.done():
            self._is_reset, self._pose = True, None

    def _drive(self, pose: Any) -> None:
        if self._goal is None:
            self._goal = _ahead(pose)
            self._say_goal()
        if not self._is_reached(pose, self._goal):
            self._command(*((0.0, _TURNING_SPEED) if self._turns else (_SPEED, 0.0)))
        elif abs(pose.linear_velocity) > _STILL or abs(pose.angular_velocity) > _STILL:
            self._command(0.0, 0.0)
        else:
            self.get_logger().info("Reached goal")
            self._turns = not self._turns
            x, y, theta = pose.x, pose.y, normalized(pose.theta + math.pi / 2)
            self._goal = (x, y, theta) if self._turns else _ahead(pose)
            self._say_goal()

    def _is_reached(self, pose: Any, goal: tuple[float, float, float]) -> bool:
        """Return whether the goal is reached or passed, since commands arrive late."""
        x, y, theta = goal
        if self._turns:
            return normalized(theta - pose.theta) < _NEAR_ANGLE
        return bool((x - pose.x) * math.cos(theta) + (y - pose.y) * math.sin(theta) < _NEAR)

    def _say_goal(self) -> None:
        if self._goal is not None:
            x, y, theta = self._goal
            self.get_logger().info(f"New goal [{x:f} {y:f}, {theta:f}]")

    def _command(self, forward: float, angular: float) -> None:
        from geometry_msgs.msg import Twist, Vector3

        self._commands.publish(Twist(linear=Vector3(x=forward), angular=Vector3(z=angular)))


def _ahead(pose: Any) -> tuple[float, float, float]:
    """Return the pose a side ahead."""
    return pose.x + _SIDE * math.cos(pose.theta), pose.y + _SIDE * math.sin(pose.theta), pose.theta
