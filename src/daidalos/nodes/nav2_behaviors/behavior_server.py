"""`behavior_server`: spin, back up, drive on heading and wait, to free a stuck robot."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np
from rclpy.lifecycle import LifecycleState, TransitionCallbackReturn
from rclpy.time import Time
from tf2_ros import Buffer, TransformException, TransformListener

from daidalos.common.parameters import Parameters, parameter
from daidalos.common.pose2 import transform_points
from daidalos.navigation.contracts import Behavior, NavigationContext
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.errors import NavigationError
from daidalos.navigation.extensions import BEHAVIORS
from daidalos.nodes.action_results import TransformFailed
from daidalos.nodes.conversions import pose2_of_transform, twist_message
from daidalos.nodes.cycles import Cycle, wait_until
from daidalos.nodes.managed import ManagedNode
from daidalos.nodes.nav2_costmap_2d._costmap_messages import costmap_of
from daidalos.nodes.navigation_extensions import ExtensionMaker
from daidalos.nodes.parameters import declare
from daidalos.nodes.qos import LATCHED
from daidalos.samples.fields import duration_message, seconds

_TIMEOUT_S = 10.0
"""Timeout of a goal for the robot pose and the costmap, which arrive soon after a normal start."""


_FOOTPRINT_TOLERANCE = 0.005
"""Difference [m] of corners, as of rounding and of transforms, that is no other outline."""

_DEFAULT_PLUGINS = {
    "spin": "nav2_behaviors::Spin",
    "backup": "nav2_behaviors::BackUp",
    "drive_on_heading": "nav2_behaviors::DriveOnHeading",
    "wait": "nav2_behaviors::Wait",
}


@dataclass(frozen=True)
class BehaviorServerParameters(Parameters):
    """Parameters of the node, by their Nav2 names; `robot_radius` is ours."""

    cycle_frequency: float = parameter(10.0, "Cycles per second.", unit="Hz", above=0.0, read_only=True)
    local_frame: str = parameter("odom", "Frame in which motions are measured.", not_empty=True, read_only=True)
    robot_base_frame: str = parameter("base_link", "Frame of the robot's base.", not_empty=True, read_only=True)
    enable_stamped_cmd_vel: bool = parameter(False, "Whether cmd_vel is stamped.", read_only=True)
    behavior_plugins: tuple[str, ...] = parameter(
        tuple(_DEFAULT_PLUGINS), "Names of the behaviours and of their actions.", unique=True, read_only=True
    )
    local_costmap_topic: str = parameter(
        "local_costmap/costmap_raw", "Topic of the costmap for the collision checks.", not_empty=True, read_only=True
    )
    local_footprint_topic: str = parameter(
        "local_costmap/published_footprint", "Topic of the robot's outline for the collision checks.", not_empty=True,
        read_only=True,
    )  # fmt: skip
    robot_radius: float = parameter(
        0.22, "Radius of the robot until its outline was received.", unit="m", above=0.0, read_only=True
    )


class BehaviorServer(ManagedNode):
    """Server of an action for every behavior."""

    def __init__(self, node_name: str = "behavior_server", **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        self._settings = declare(self, BehaviorServerParameters)
        self._footprint = Footprint.circle(self._settings.robot_radius)
        self._behaviors: list[Behavior[Any]] = []
        self._costmap: Costmap | None = None
        self._velocity = np.zeros(3)
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)

    def configure(self) -> None:
        """Make the behaviours and serve."""
        from geometry_msgs.msg import PolygonStamped, Twist, TwistStamped
        from nav2_msgs.msg import Costmap as CostmapMessage
        from nav_msgs.msg import Odometry
        from rosidl_runtime_py.utilities import get_action

        self._command = self.create_publisher(
            TwistStamped if self._settings.enable_stamped_cmd_vel else Twist, "cmd_vel", 1
        )
        p = self._settings
        self.create_subscription(CostmapMessage, p.local_costmap_topic, self._on_costmap, LATCHED)
        self.create_subscription(PolygonStamped, p.local_footprint_topic, self._on_footprint, 1)
        self.create_subscription(Odometry, "odom", self._on_odometry, 10)
        context = NavigationContext(
            footprint=self._footprint,
            frequency=p.cycle_frequency,
            global_frame=p.local_frame,
            base_frame=p.robot_base_frame,
        )
        maker = ExtensionMaker(self, context)
        self._behaviors.clear()
        for name in p.behavior_plugins:
            behavior: Behavior[Any] = maker.make(BEHAVIORS, name, _DEFAULT_PLUGINS.get(name, ""))
            self._behaviors.append(behavior)
            action = get_action(behavior.action)
            self.serve_action(action, name, self._executor_of(behavior, action))

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop the robot where a behaviour moves it, and abort the goals."""
        if self._goals:
            self._publish_velocity(np.zeros(3))
        return super().on_deactivate(state)

    def _on_costmap(self, message: Any) -> None:
        self._costmap = costmap_of(message)

    def _on_footprint(self, message: Any) -> None:
        """Take the robot's outline, which is published where the robot stands."""
        try:
            found = self._buffer.lookup_transform(
                self._settings.robot_base_frame, message.header.frame_id, Time.from_msg(message.header.stamp)
            )
        except TransformException:
            return  # another one comes
        corners = np.array([(point.x, point.y) for point in message.polygon.points]).reshape(-1, 2)
        corners = transform_points(pose2_of_transform(found.transform), corners)
        known = self._footprint.polygon
        if corners.shape == known.shape and np.allclose(corners, known, atol=_FOOTPRINT_TOLERANCE):
            return
        try:
            self._footprint = Footprint.of_corners(corners)
        except NavigationError as error:
            self.get_logger().warning(f"{self._settings.local_footprint_topic}: {error}")
            return
        for behavior in self._behaviors:
            behavior.set_footprint(self._footprint)

    def _on_odometry(self, message: Any) -> None:
        twist = message.twist.twist
        self._velocity = np.array([twist.linear.x, twist.linear.y, twist.angular.z])

    def _executor_of(self, behavior: Behavior[Any], action: Any) -> Callable[[Any], Any]:
        async def execute(goal_handle: Any) -> Any:
            result = action.Result()
            begun = self.get_clock().now()
            await wait_until(
                lambda: self._is_over(goal_handle) or self._is_known(), self, self._settings.cycle_frequency, _TIMEOUT_S
            )
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
        return self._costmap is not None and bool(
            self._buffer.can_transform(self._settings.local_frame, self._settings.robot_base_frame, Time())
        )

    async def _behave(self, behavior: Behavior[Any], action: Any, goal_handle: Any) -> None:
        """Carry out a behaviour until it is done or its goal is over, and stop the robot."""
        try:
            behavior.start(behavior.command(_plain(goal_handle.request)), self._pose(), self._now())
            with Cycle(self, self._settings.cycle_frequency) as cycle:
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
            found = self._buffer.lookup_transform(self._settings.local_frame, self._settings.robot_base_frame, Time())
        except TransformException as error:
            raise TransformFailed(str(error)) from None
        return pose2_of_transform(found.transform)

    def _publish_velocity(self, velocity: Any) -> None:
        frame = self._settings.robot_base_frame if self._settings.enable_stamped_cmd_vel else None
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
