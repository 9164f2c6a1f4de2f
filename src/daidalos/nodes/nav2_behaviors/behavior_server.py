"""`behavior_server`: spin, back up, drive on heading, assisted teleoperation and wait."""

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
from daidalos.navigation.contracts import Behavior, Input, NavigationContext
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.extensions import BEHAVIORS
from daidalos.nodes.action_results import TransformFailed
from daidalos.nodes.conversions import pose2_of_transform, twist_message, velocity_of
from daidalos.nodes.cycles import Cycle, wait_until
from daidalos.nodes.managed import ManagedNode
from daidalos.nodes.nav2_costmap_2d._costmap_listener import CostmapListener
from daidalos.nodes.navigation_extensions import ExtensionMaker
from daidalos.nodes.parameters import declare, declare_name, declare_without_effect
from daidalos.samples.fields import duration_message, nanoseconds, seconds

_NOTHING = Costmap.filled(1, 1, 0.05, (0.0, 0.0))
"""Costmap for behaviours that do not look at it."""

_TIMEOUT_S = 10.0
"""Timeout of a goal for the robot pose and the costmap, which arrive soon after a normal start."""


_DEFAULT_PLUGINS = {
    "spin": "nav2_behaviors::Spin",
    "backup": "nav2_behaviors::BackUp",
    "drive_on_heading": "nav2_behaviors::DriveOnHeading",
    "assisted_teleop": "nav2_behaviors::AssistedTeleop",
    "wait": "nav2_behaviors::Wait",
}

_SHARED = ("simulate_ahead_time", "max_rotational_vel", "min_rotational_vel", "rotational_acc_lim")
"""Parameters of the server that are defaults of the behaviours' parameters."""

_FORMER_NAMES = (
    ("local_costmap_topic", "costmap_topic", "local_costmap/costmap_raw"),
    ("local_footprint_topic", "footprint_topic", "local_costmap/published_footprint"),
)
"""Parameters that have another name in Nav2's older releases, that name, and the default."""

_WITHOUT_EFFECT = {
    "transform_tolerance": "the age of transforms is limited by data_timeout",
    "global_frame": "no behaviour uses the global costmap",
    "global_costmap_topic": "no behaviour uses the global costmap",
    "global_footprint_topic": "no behaviour uses the global costmap",
    "bond_heartbeat_period": "there are no bonds; the lifecycle manager asks for states",
    "action_server_result_timeout": "results are kept as long as the server runs",
}
"""Parameters of some of Nav2's releases that do nothing here, with the reason."""


@dataclass(frozen=True)
class BehaviorServerParameters(Parameters):
    """Parameters of the node, by their Nav2 names; `robot_radius` and `data_timeout` are ours.

    The last four are for all behaviours that have a parameter of that name, and do not set it under their own.
    """

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
    data_timeout: float = parameter(
        1.0, "Age of the costmap or of the robot's transform from which a behaviour that moves the robot is aborted.",
        unit="s", above=0.0,
    )  # fmt: skip
    simulate_ahead_time: float = parameter(
        2.0, "How far ahead motions are checked for collisions.", unit="s", minimum=0.0, read_only=True
    )
    max_rotational_vel: float = parameter(1.0, "Largest turn rate.", unit="rad/s", above=0.0, read_only=True)
    min_rotational_vel: float = parameter(0.4, "Least turn rate.", unit="rad/s", minimum=0.0, read_only=True)
    rotational_acc_lim: float = parameter(3.2, "Largest turn acceleration.", unit="rad/s^2", above=0.0, read_only=True)


class BehaviorServer(ManagedNode):
    """Server of an action for every behavior."""

    def __init__(self, node_name: str = "behavior_server", **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        older = {
            name: declare_name(self, former, str(value), f"Former name of {name}.")
            for name, former, value in _FORMER_NAMES
            if former in self._parameter_overrides
        }
        self._settings = declare(self, BehaviorServerParameters, defaults=older)
        self._behaviors: list[Behavior[Any]] = []
        self._velocity = np.zeros(3)
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)

    def configure(self) -> None:
        """Make the behaviours and serve."""
        from geometry_msgs.msg import Twist, TwistStamped
        from nav_msgs.msg import Odometry
        from rosidl_runtime_py.utilities import get_action

        self._command = self.create_publisher(
            TwistStamped if self._settings.enable_stamped_cmd_vel else Twist, "cmd_vel", 1
        )
        p = self._settings
        self._surroundings = CostmapListener(
            self, self._buffer, p.robot_base_frame, p.local_costmap_topic, p.local_footprint_topic,
            Footprint.circle(p.robot_radius), self._on_footprint,
        )  # fmt: skip
        self.create_subscription(Odometry, "odom", self._on_odometry, 10)
        context = NavigationContext(
            footprint=self._surroundings.footprint,
            frequency=p.cycle_frequency,
            global_frame=p.local_frame,
            base_frame=p.robot_base_frame,
        )
        maker = ExtensionMaker(self, context)
        defaults = {name: getattr(p, name) for name in _SHARED}
        declare_without_effect(self, _WITHOUT_EFFECT)
        self._behaviors.clear()
        for name in p.behavior_plugins:
            behavior: Behavior[Any] = maker.make(BEHAVIORS, name, _DEFAULT_PLUGINS.get(name, ""), defaults)
            self._behaviors.append(behavior)
            for one in behavior.inputs:
                self._listen(one)
            action = get_action(behavior.action)
            self.serve_action(action, name, self._executor_of(behavior, action))

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop the robot where a behaviour moves it, and abort the goals."""
        if self._goals:
            self._publish_velocity(np.zeros(3))
        return super().on_deactivate(state)

    def _on_footprint(self, footprint: Footprint) -> None:
        for behavior in self._behaviors:
            behavior.set_footprint(footprint)

    def _listen(self, listened: Input) -> None:
        from geometry_msgs.msg import Twist, TwistStamped
        from std_msgs.msg import Empty

        if listened.type is type(None):
            self.create_subscription(Empty, listened.topic, lambda message: listened.take(), 1)
        elif self._settings.enable_stamped_cmd_vel:
            self.create_subscription(
                TwistStamped,
                listened.topic,
                lambda message: listened.take(velocity_of(message.twist), seconds(message.header.stamp)),
                1,
            )
        else:
            self.create_subscription(
                Twist, listened.topic, lambda message: listened.take(velocity_of(message), self._now()), 1
            )

    def _on_odometry(self, message: Any) -> None:
        self._velocity = velocity_of(message.twist.twist)

    def _executor_of(self, behavior: Behavior[Any], action: Any) -> Callable[[Any], Any]:
        async def execute(goal_handle: Any) -> Any:
            result = action.Result()
            begun = self.get_clock().now()
            await wait_until(
                lambda: self._is_over(goal_handle) or not self._problem(behavior),
                self,
                self._settings.cycle_frequency,
                _TIMEOUT_S,
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

    def _problem(self, behavior: Behavior[Any]) -> str:
        """Return what is not known that a behaviour needs, in words; empty where it can go on.

        The first goal may come before anything is known.
        """
        limit = self._settings.data_timeout
        if not self._buffer.can_transform(self._settings.local_frame, self._settings.robot_base_frame, Time()):
            return f"there is no transform from {self._settings.robot_base_frame} to {self._settings.local_frame}"
        if not behavior.moves:
            return ""
        age = self._surroundings.age
        if not age <= limit:
            seen = (
                "there is no costmap" if age == np.inf else f"the costmap is {age:.3g} s old, longer than {limit:g} s,"
            )
            return f"{seen} on '{self._settings.local_costmap_topic}'"
        age = self._age_of_pose()
        return "" if age <= limit else f"the robot's transform is {age:.3g} s old, longer than {limit:g} s"

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
        problem = self._problem(behavior)
        if problem:
            raise TransformFailed(problem)
        step = behavior.step(self._pose(), self._velocity, self._surroundings.costmap or _NOTHING, self._now())
        self._publish_velocity(step.velocity)
        if behavior.feedback:
            goal_handle.publish_feedback(_feedback(action, behavior.feedback, step.feedback))
        return not step.done

    def _now(self) -> float:
        return self.get_clock().now().nanoseconds * 1e-9

    def _transform(self) -> Any:
        try:
            return self._buffer.lookup_transform(self._settings.local_frame, self._settings.robot_base_frame, Time())
        except TransformException as error:
            raise TransformFailed(str(error)) from None

    def _pose(self) -> Any:
        return pose2_of_transform(self._transform().transform)

    def _age_of_pose(self) -> float:
        """Return the age [s] of the robot's transform; 0 for a static one, which has no time."""
        stamp_ns = nanoseconds(self._transform().header.stamp)
        return (self.get_clock().now().nanoseconds - stamp_ns) * 1e-9 if stamp_ns else 0.0

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
