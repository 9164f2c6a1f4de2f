"""`behavior_server`: turns, backs up, drives on and waits, to get a stuck robot going again."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from rclpy.action import ActionServer, CancelResponse
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
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
from daidalos.navigation.errors import NavigationError
from daidalos.navigation.plugins import find_plugin
from daidalos.nodes.action_results import TransformFailed, set_error
from daidalos.nodes.conversions import duration_message, pose2_of_transform, seconds, twist_message
from daidalos.nodes.cycles import Cycle
from daidalos.nodes.nav2_costmap_2d._costmap_messages import costmap_of
from daidalos.nodes.parameters import declare_plugin
from daidalos.nodes.runner import run

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


class BehaviorServer(LifecycleNode):
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

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
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
        self._servers = []
        for name in self.get_parameter("behavior_plugins").value:
            kind_name = self.declare_parameter(f"{name}.plugin", _DEFAULT_PLUGINS.get(name, "")).value
            kind = _KINDS[kind_name.replace("/", "::")]
            behavior = self._make(kind_name, name)
            action = getattr(nav2_msgs.action, kind.action)
            self._servers.append(
                ActionServer(
                    self,
                    action,
                    name,
                    self._executor_of(behavior, kind, action),
                    cancel_callback=lambda goal: CancelResponse.ACCEPT,
                )
            )
        return super().on_configure(state)

    def _make(self, kind: str, name: str) -> Behavior[Any]:
        plugin = find_plugin(kind)
        parameters = declare_plugin(self, plugin, name)
        further = () if parameters is None else (parameters,)
        behavior: Behavior[Any] = plugin.made_by(self._footprint, *further, cycle_frequency=self._frequency)
        return behavior

    def _on_costmap(self, message: Any) -> None:
        self._costmap = costmap_of(message)

    def _on_odometry(self, message: Any) -> None:
        twist = message.twist.twist
        self._velocity = np.array([twist.linear.x, twist.linear.y, twist.angular.z])

    def _executor_of(self, behavior: Behavior[Any], kind: _Kind, action: Any) -> Callable[[Any], Any]:
        async def execute(goal_handle: Any) -> Any:
            result = action.Result()
            begun = self.get_clock().now()
            await self._until_known(goal_handle)
            if goal_handle.is_cancel_requested:
                goal_handle.canceled()
                return result
            try:
                behavior.start(kind.command(goal_handle.request), self._pose(), self._now())
                with Cycle(self, self._frequency) as cycle:
                    while await self._go_on(behavior, kind, action, goal_handle):
                        await cycle.next()
            except NavigationError as error:
                self._publish_velocity(np.zeros(3))
                self.get_logger().warning(f"{kind.action} failed: {error}")
                goal_handle.abort()
                return set_error(result, error)
            self._publish_velocity(np.zeros(3))
            result.total_elapsed_time = (self.get_clock().now() - begun).to_msg()
            goal_handle.canceled() if goal_handle.is_cancel_requested else goal_handle.succeed()
            return result

        return execute

    async def _until_known(self, goal_handle: Any) -> None:
        """Wait for the robot's place and for what is around it: the first goal may come before they do."""
        begun = time.monotonic()
        with Cycle(self, self._frequency) as cycle:
            while not goal_handle.is_cancel_requested and time.monotonic() - begun < _TIMEOUT_S:
                known = self._buffer.can_transform(self._frame, self._base_frame, Time())
                if self._costmap is not None and known:
                    return
                await cycle.next()

    async def _go_on(self, behavior: Behavior[Any], kind: _Kind, action: Any, goal_handle: Any) -> bool:
        """Make one cycle; False when the behaviour is done or cancelled."""
        if goal_handle.is_cancel_requested:
            return False
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
