"""`behavior_server`: turns, backs up, drives on and waits, to get a stuck robot going again."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from rclpy.lifecycle import LifecycleState, TransitionCallbackReturn
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.time import Time
from tf2_ros import Buffer, TransformException, TransformListener

from daidalos.navigation.behaviors.back_up import BackUpCommand
from daidalos.navigation.behaviors.behavior import Behavior, BehaviorStep
from daidalos.navigation.behaviors.drive_on_heading import DriveOnHeadingCommand
from daidalos.navigation.behaviors.spin import SpinCommand
from daidalos.navigation.behaviors.wait import WaitCommand
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.plugins import find_plugin
from daidalos.nodes.action_results import TransformFailed
from daidalos.nodes.conversions import pose2_of_transform, twist_message
from daidalos.nodes.cycles import Cycle, wait_until
from daidalos.nodes.managed import ManagedNode
from daidalos.nodes.nav2_costmap_2d._costmap_messages import costmap_of
from daidalos.nodes.parameters import declare_plugin
from daidalos.nodes.runner import run
from daidalos.samples.fields import duration_message, seconds

_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
_TIMEOUT_S = 10.0
"""How long a goal waits for the robot's place and the costmap, which come soon after the start if all is well."""


@dataclass(frozen=True)
class _Kind:
    """What the action of a behaviour is called, and how its goal and feedback are written."""

    action: str
    command: Callable[[Any], Any]
    feedback: str


_KINDS = {
    "nav2_behaviors::Spin": _Kind(
        "Spin", lambda goal: SpinCommand(goal.target_yaw, seconds(goal.time_allowance)), "angular_distance_traveled"
    ),
    "nav2_behaviors::BackUp": _Kind(
        "BackUp",
        lambda goal: BackUpCommand(abs(goal.target.x), abs(goal.speed), seconds(goal.time_allowance)),
        "distance_traveled",
    ),
    "nav2_behaviors::DriveOnHeading": _Kind(
        "DriveOnHeading",
        lambda goal: DriveOnHeadingCommand(goal.target.x, goal.speed, seconds(goal.time_allowance)),
        "distance_traveled",
    ),
    "nav2_behaviors::Wait": _Kind("Wait", lambda goal: WaitCommand(seconds(goal.time)), "time_left"),
}
_DEFAULT_PLUGINS = {
    "spin": "nav2_behaviors::Spin",
    "backup": "nav2_behaviors::BackUp",
    "drive_on_heading": "nav2_behaviors::DriveOnHeading",
    "wait": "nav2_behaviors::Wait",
}


class BehaviorServer(ManagedNode):
    """Serves an action for every behaviour; parameters are Nav2's."""

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
        import nav2_msgs.action
        from geometry_msgs.msg import Twist, TwistStamped
        from nav2_msgs.msg import Costmap as CostmapMessage
        from nav_msgs.msg import Odometry

        self._command = self.create_publisher(TwistStamped if self._stamped else Twist, "cmd_vel", 1)
        self.create_subscription(
            CostmapMessage, self.get_parameter("local_costmap_topic").value, self._on_costmap, _LATCHED
        )
        self.create_subscription(Odometry, "odom", self._on_odometry, 10)
        for name in self.get_parameter("behavior_plugins").value:
            kind_name = self.declare_parameter(f"{name}.plugin", _DEFAULT_PLUGINS.get(name, "")).value
            kind = _KINDS[kind_name.replace("/", "::")]
            behavior = self._make(kind_name, name)
            action = getattr(nav2_msgs.action, kind.action)
            self.serve_action(action, name, self._executor_of(behavior, kind, action))

    def _make(self, kind: str, name: str) -> Behavior[Any]:
        plugin = find_plugin(kind)
        parameters = declare_plugin(self, plugin, name)
        further = () if parameters is None else (parameters,)
        behavior: Behavior[Any] = plugin.made_by(self._footprint, *further, cycle_frequency=self._frequency)
        return behavior

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

    def _executor_of(self, behavior: Behavior[Any], kind: _Kind, action: Any) -> Callable[[Any], Any]:
        async def execute(goal_handle: Any) -> Any:
            result = action.Result()
            begun = self.get_clock().now()
            await wait_until(lambda: self._is_over(goal_handle) or self._is_known(), self, self._frequency, _TIMEOUT_S)
            if not self._is_over(goal_handle):
                await self._behave(behavior, kind, action, goal_handle)
            if not goal_handle.is_active:
                return result
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

    async def _behave(self, behavior: Behavior[Any], kind: _Kind, action: Any, goal_handle: Any) -> None:
        """Carry out a behaviour until it is done or its goal is over, and stop the robot."""
        try:
            behavior.start(kind.command(goal_handle.request), self._pose(), self._now())
            with Cycle(self, self._frequency) as cycle:
                while not self._is_over(goal_handle) and self._go_on(behavior, kind, action, goal_handle):
                    await cycle.next()
        finally:
            if self.is_active:
                self._publish_velocity(np.zeros(3))

    def _go_on(self, behavior: Behavior[Any], kind: _Kind, action: Any, goal_handle: Any) -> bool:
        """Make one cycle; False when the behaviour is done."""
        if self._costmap is None:
            raise TransformFailed("no local costmap has come yet")
        step = behavior.step(self._pose(), self._velocity, self._costmap, self._now())
        self._publish_velocity(step.velocity)
        goal_handle.publish_feedback(_feedback(action, kind, step))
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


def _feedback(action: Any, kind: _Kind, step: BehaviorStep) -> Any:
    feedback = action.Feedback()
    value = float(step.feedback)
    setattr(feedback, kind.feedback, duration_message(value) if kind.feedback == "time_left" else value)
    return feedback


def main() -> int:
    """Run the node."""
    return run(BehaviorServer)


if __name__ == "__main__":
    sys.exit(main())
