"""Topics, services and action of a turtle."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from rclpy.task import Future

from daidalos.nodes.turtlesim._turtle import Pen, Turtle

if TYPE_CHECKING:
    from daidalos.nodes.turtlesim.turtlesim_node import TurtleSim

_MAX_MAGNITUDE = 1e30  # of units; what is more, or no number, is a mistake


@dataclass(frozen=True)
class _Rotation:
    """Goal of the action under execution."""

    goal: Any
    over: Future
    begun_at: float


class TurtleInterface:
    """Interface of a turtle to the graph.

    Parameters
    ----------
    node
        Offers the topics, services and the action.
    turtle
        Who is steered.
    moved
        Called with where it was when it was put elsewhere, so that its pen can draw.
    """

    def __init__(
        self,
        node: TurtleSim,
        turtle: Turtle,
        moved: Callable[[Turtle, tuple[float, float]], None],
    ) -> None:
        from geometry_msgs.msg import Twist
        from rclpy.action import ActionServer, CancelResponse
        from turtlesim.action import RotateAbsolute
        from turtlesim.msg import Color, Pose
        from turtlesim.srv import SetPen, TeleportAbsolute, TeleportRelative

        self.turtle = turtle
        self._node = node
        self._moved = moved
        self._rotation: _Rotation | None = None
        name = turtle.name
        events = node.waking_events
        self._pose = node.create_publisher(Pose, f"{name}/pose", 10, event_callbacks=events)
        self._colour = node.create_publisher(Color, f"{name}/color_sensor", 10, event_callbacks=events)
        self._commands = node.create_subscription(Twist, f"{name}/cmd_vel", self._on_command, 10)
        self._services = [
            node.create_service(SetPen, f"{name}/set_pen", self._on_set_pen),
            node.create_service(TeleportRelative, f"{name}/teleport_relative", self._on_teleport_relative),
            node.create_service(TeleportAbsolute, f"{name}/teleport_absolute", self._on_teleport_absolute),
        ]
        self._action = ActionServer(
            node,
            RotateAbsolute,
            f"{name}/rotate_absolute",
            self._end_of_rotation,
            cancel_callback=lambda goal: CancelResponse.ACCEPT,
            handle_accepted_callback=self._on_goal,
        )

    def publish(self, colour_below: Callable[[Turtle], tuple[int, int, int]]) -> bool:
        """Publish the turtle's pose and the colour below it to those who listen; return whether anybody does."""
        from turtlesim.msg import Color, Pose

        turtle = self.turtle
        wants_pose, wants_colour = self._pose.handle.has_subscribers, self._colour.handle.has_subscribers
        if wants_pose:
            speed = math.hypot(turtle.forward, turtle.sideways) if turtle.sideways else turtle.forward
            self._pose.publish(
                Pose(
                    x=turtle.x,
                    y=turtle.y,
                    theta=turtle.theta,
                    linear_velocity=speed,
                    angular_velocity=turtle.angular,
                )
            )
        if wants_colour:
            r, g, b = colour_below(turtle)
            self._colour.publish(Color(r=r, g=g, b=b))
        return wants_pose or wants_colour

    def close(self) -> None:
        """Close topics, services and action."""
        self.abort_rotation()
        self._action.destroy()
        for publisher in (self._pose, self._colour):
            self._node.destroy_publisher(publisher)
        self._node.destroy_subscription(self._commands)
        for service in self._services:
            self._node.destroy_service(service)

    # Topic and services.

    def _on_command(self, twist: Any) -> None:
        sideways = twist.linear.y if self._node.settings.holonomic else 0.0
        if self._can_be(twist.linear.x, sideways, twist.angular.z):
            self.turtle.command(twist.linear.x, sideways, twist.angular.z, self._now_s())
            self._node.wake()

    def _on_set_pen(self, request: Any, response: Any) -> Any:
        if request.off:
            self.turtle.pen = replace(self.turtle.pen, is_down=False)
        else:
            self.turtle.pen = Pen(request.r, request.g, request.b, request.width)
        return response

    def _on_teleport_relative(self, request: Any, response: Any) -> Any:
        if self._can_be(request.linear, request.angular):
            before = (self.turtle.x, self.turtle.y)
            self.turtle.teleport_relative(request.linear, request.angular)
            self._moved(self.turtle, before)
            self._node.wake()
        return response

    def _on_teleport_absolute(self, request: Any, response: Any) -> Any:
        if self._can_be(request.x, request.y, request.theta):
            before = (self.turtle.x, self.turtle.y)
            self.turtle.teleport(request.x, request.y, request.theta)
            self._moved(self.turtle, before)
            self._node.wake()
        return response

    def _can_be(self, *numbers: float) -> bool:
        """Return whether numbers are valid positions and speeds; log an error if they are not."""
        if all(abs(number) < _MAX_MAGNITUDE for number in numbers):
            return True
        self._node.get_logger().error(f"Turtle [{self.turtle.name}] cannot obey {numbers}")
        return False

    # Action.

    def _on_goal(self, goal: Any) -> None:
        if self._rotation is not None:
            self._node.get_logger().warning(
                "Rotation goal received before a previous goal finished. Aborting previous goal"
            )
            self.abort_rotation()
        self._rotation = _Rotation(goal, Future(), self.turtle.theta)
        self._node.wake()
        goal.execute()

    def _end_of_rotation(self, goal: Any) -> Any:
        """Return what is done when a goal is; None where it is so already, because another one took its place."""
        rotation = self._rotation
        return rotation.over if rotation is not None and rotation.goal == goal else None

    def turn(self) -> bool:
        """Turn towards the goal of the action, if there is one; return whether there is."""
        from turtlesim.action import RotateAbsolute

        rotation = self._rotation
        if rotation is None:
            return False
        goal = rotation.goal
        left = self.turtle.turn_towards(goal.request.theta, self._now_s())
        goal.publish_feedback(RotateAbsolute.Feedback(remaining=left))
        if goal.is_cancel_requested:
            self.turtle.stop()
            self._node.get_logger().info("Rotation goal canceled")
            self._end_rotation(goal.canceled)
        elif self.turtle.angular == 0.0:
            self._node.get_logger().info("Rotation goal completed successfully")
            self._end_rotation(goal.succeed)
        return True

    def abort_rotation(self) -> None:
        """Abort the goal of the action, if there is one."""
        if self._rotation is not None:
            self._end_rotation(self._rotation.goal.abort)

    def _end_rotation(self, end: Callable[[Any], None]) -> None:
        from turtlesim.action import RotateAbsolute

        rotation, self._rotation = self._rotation, None
        if rotation is not None:
            end(RotateAbsolute.Result(delta=self.turtle.angle_to(rotation.begun_at)))
            rotation.over.set_result(None)

    def _now_s(self) -> float:
        return float(self._node.get_clock().now().nanoseconds) * 1e-9
