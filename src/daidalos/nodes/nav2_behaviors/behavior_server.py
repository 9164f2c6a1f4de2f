"""`behavior_server`: spin, back up, drive on heading and wait, to free a stuck robot."""

from __future__ import annotations

import sys
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
from rclpy.lifecycle import LifecycleState, TransitionCallbackReturn
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.time import Time
from tf2_ros import Buffer, TransformException, TransformListener

from daidalos.navigation.contracts import Behavior, NavigationContext
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.extensions import BEHAVIORS
from daidalos.nodes.action_results import TransformFailed
from daidalos.nodes.conversions import pose2_of_transform, twist_message
from daidalos.nodes.cycles import Cycle, wait_until
from daidalos.nodes.managed import ManagedNode
from daidalos.nodes.nav2_costmap_2d._costmap_messages import costmap_of
from daidalos.nodes.navigation_extensions import ExtensionMaker
from daidalos.nodes.runner import run
from daidalos.samples.fields import duration_message, seconds

_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
_TIMEOUT_S = 10.0
"""Timeout of a goal for the robot pose and the costmap, which arrive soon after a normal start."""


_DEFAULT_PLUGINS = {
    "spin": "nav2_behaviors::Spin",
    "backup": "nav2_behaviors::BackUp",
    "drive_on_heading": "nav2_behaviors::DriveOnHeading",
    "wait": "nav2_behaviors::Wait",
}


class BehaviorServer(ManagedNode):
    """Server of an action for every behavior; parameters are Nav2's."""

    def __init__(self, node_name: str = "behavior_server", **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        self._frequency = self.declare_parameter("cycle_frequency", 10.0).value
        self._frame = self.declare_parameter("local_frame", "odom").value
        self._base_frame = self.declare_parameter("robot_base_frame", "base_link").value
        self._stamped = self.declare_parameter("enable_stamped_cmd_vel", False).value
        self.declare_parameter("behavior_plugins", list(_DEFAULT_PLUGINS))
        self.declare_parameter("local_costmap_topic", "local_costmap/costmap_raw")
        self.declare_parameter("local_footprint_topic", "local_costmap/published_footprint")
        self.declare_parameter("robot_radius", 0.22)
        self._footprint = Footprint.circle(self.get_parameter("robot_radius").value)
        self._costmap: Costmap | None = None
        self._velocity = np.zeros(3)
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)

    def configure(self) -> None:
        """Make the behaviours and serve."""
        from geometry_msgs.msg import Twist, TwistStamped
        from nav2_msgs.msg import Costmap as CostmapMessage
        from nav_msgs.msg import Odometry
        from rosidl_runtime_py.utilities import get_action

        self._command = self.create_publisher(TwistStamped if self._stamped else Twist, "cmd_vel", 1)
        self.create_subscription(
            CostmapMessage, self.get_parameter("local_costmap_topic").value, self._on_costmap, _LATCHED
        )
        self.create_subscription(Odometry, "odom", self._on_odometry, 10)
        context = NavigationContext(
            footprint=self._footprint,
            frequency=self._frequency,
            global_frame=self._frame,
            base_frame=self._base_frame,
        )
        maker = ExtensionMaker(self, context)
        for name in self.get_parameter("behavior_plugins").value:
            behavior: Behavior[Any] = maker.make(BEHAVIORS, name, _DEFAULT_PLUGINS.get(name, ""))
            action = get_action(behavior.action)
            self.serve_action(action, name, self._executor_of(behavior, action))

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop the robot where a behaviour moves it, and abort the goals."""
        if self._goals:
            self._publish_velocity(np.zeros(3))
        return super().on_deactivate(state)

    def _on_costmap(self, message: Any) -> None:
        self._costmap = costmap_of(message)

    def _on_odometry(self, message: Any) -> None:
        twist = message.twist.twist
        self._velocity = np.array([twist.linear.x, twist.linear.y, twist.angular.z])

    def _executor_of(self, behavior: Behavior[Any], action: Any) -> Callable[[Any], Any]:
        async def execute(goal_handle: Any) -> Any:
            result = action.Result()
            begun = self.get_clock().now()
            await wait_until(lambda: self._is_over(goal_handle) or self._is_known(), self, self._frequency, _TIMEOUT_S)
            if not self._is_over(goal_handle):
                await self._behave(behavior, action, goal_handle)
            if not goal_handle.is_active:
                return result
            if hasattr(result, "total_elapsed_time"):
                result.total_elapsed_time = (self.get_clock().now() - begun).to_msg()
            goal_handle.canceled() if goal_handle.is_cancel_requested else goal_handle.succeed()
            return result

        return execute

    def _is_over(self, goal_handle: Any) -> bool:
        """Return whether a goal is cancelled or aborted."""
        return goal_handle.is_cancel_requested or not goal_handle.is_active

    def _is_known(self) -> bool:
        """Return whether the robot's pose and what is around it are known: the first goal may come before they are."""
        return self._costmap is not None and bool(self._buffer.can_transform(self._frame, self._base_frame, Time()))

    async def _behave(self, behavior: Behavior[Any], action: Any, goal_handle: Any) -> None:
        """Carry out a behaviour until it is done or its goal is over, and stop the robot."""
        try:
            behavior.start(behavior.command(_plain(goal_handle.request)), self._pose(), self._now())
            with Cycle(self, self._frequency) as cycle:
                while not self._is_over(goal_handle) and self._go_on(behavior, action, goal_handle):
                    await cycle.next()
        finally:
            if self.is_active:
                self._publish_velocity(np.zeros(3))

    def _go_on(self, behavior: Behavior[Any], action: Any, goal_handle: Any) -> bool:
        """Make one cycle; False when the behaviour is done."""
        if self._costmap is None:
            raise TransformFailed("no local costmap has come yet")
        step = behavior.step(self._pose(), self._velocity, self._costmap, self._now())
        self._publish_velocity(step.velocity)
        if behavior.feedback:
            goal_handle.publish_feedback(_feedback(action, behavior.feedback, step.feedback))
        return not step.done

    def _now(self) -> float:
        return self.get_clock().now().nanoseconds * 1e-9

    def _pose(self) -> Any:
        try:
            found = self._buffer.lookup_transform(self._frame, self._base_frame, Time())
        except TransformException as error:
            raise TransformFailed(str(error)) from None
        return pose2_of_transform(found.transform)

    def _publish_velocity(self, velocity: Any) -> None:
        frame = self._base_frame if self._stamped else None
        self._command.publish(twist_message(velocity, frame, self.get_clock().now().to_msg()))


def _plain(goal: Any) -> SimpleNamespace:
    """Return the fields of a goal, durations in seconds."""
    fields = {name: getattr(goal, name) for name in goal.get_fields_and_field_types()}
    return SimpleNamespace(**{name: seconds(one) if hasattr(one, "nanosec") else one for name, one in fields.items()})


def _feedback(action: Any, field: str, value: float) -> Any:
    feedback = action.Feedback()
    is_duration = hasattr(getattr(feedback, field), "nanosec")
    setattr(feedback, field, duration_message(value) if is_duration else float(value))
    return feedback


def main() -> int:
    """Run the node."""
    return run(BehaviorServer)


if __name__ == "__main__":
    sys.exit(main())
