"""`controller_server`: follows paths over the local costmap."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from rclpy.lifecycle import LifecycleState, TransitionCallbackReturn

from daidalos.common.extensions import Kind
from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.controllers.follow_path import FollowPath
from daidalos.navigation.errors import NavigationError
from daidalos.navigation.extensions import CONTROLLERS, GOAL_CHECKERS, PATH_HANDLERS, PROGRESS_CHECKERS
from daidalos.nodes.action_results import TransformFailed
from daidalos.nodes.conversions import path_array, path_message, twist_message, velocity_of
from daidalos.nodes.cycles import Cycle
from daidalos.nodes.managed import ContainedNode, ManagedNode
from daidalos.nodes.nav2_controller._outputs import ControllerOutputs
from daidalos.nodes.nav2_costmap_2d._costmap_node import CostmapNode, CostmapOutdated
from daidalos.nodes.navigation_extensions import ExtensionMaker
from daidalos.nodes.parameters import declare, declare_without_effect
from daidalos.nodes.warming import warm_up_in_background


class UnknownController(NavigationError):
    """There is no controller or checker of that name."""

    code = "INVALID_CONTROLLER"


@dataclass
class _Pursuit:
    """Path that the robot follows, its frame, its goal (x, y, yaw), and its plugins."""

    task: FollowPath
    plugins: tuple[str, str, str]
    frame: str
    goal: Any


_WITHOUT_EFFECT = {
    "use_realtime_priority": "no thread of Python has a real-time priority",
    "action_server_result_timeout": "results are kept as long as the server runs",
    "bond_heartbeat_period": "there are no bonds; the lifecycle manager asks for states",
}
"""Parameters of some of Nav2's releases that do nothing here, with the reason."""


@dataclass(frozen=True)
class ControllerServerParameters(Parameters):
    """Parameters of the node, by their Nav2 names."""

    controller_frequency: float = parameter(20.0, "Control cycles per second.", unit="Hz", above=0.0, read_only=True)
    failure_tolerance: float = parameter(
        0.3, "How long a controller may fail before the goal is aborted; negative for ever.", unit="s"
    )
    costmap_update_timeout: float = parameter(
        0.3, "How long to wait for the costmap and for transforms.", unit="s", minimum=0.0
    )
    odom_topic: str = parameter("odom", "Topic of the odometry.", not_empty=True, read_only=True)
    min_x_velocity_threshold: float = parameter(
        0.0001, "Measured velocity ahead below which the robot stands.", unit="m/s", minimum=0.0
    )
    min_y_velocity_threshold: float = parameter(
        0.0001, "Measured velocity aside below which the robot stands.", unit="m/s", minimum=0.0
    )
    min_theta_velocity_threshold: float = parameter(
        0.0001, "Measured turn rate below which the robot stands.", unit="rad/s", minimum=0.0
    )
    speed_limit_topic: str = parameter("speed_limit", "Topic of speed limits.", not_empty=True, read_only=True)
    enable_stamped_cmd_vel: bool = parameter(False, "Whether cmd_vel is stamped.", read_only=True)
    controller_plugins: tuple[str, ...] = parameter(
        ("FollowPath",), "Names of the controllers.", not_empty=True, unique=True, read_only=True
    )
    goal_checker_plugins: tuple[str, ...] = parameter(
        ("goal_checker",), "Names of the goal checkers.", not_empty=True, unique=True, read_only=True
    )
    progress_checker_plugins: tuple[str, ...] = parameter(
        ("progress_checker",), "Names of the progress checkers.", not_empty=True, unique=True, read_only=True
    )
    path_handler_plugins: tuple[str, ...] = parameter(
        (), "Names of the path handlers; where there is none, the controllers say what they see.", read_only=True
    )
    progress_checker_plugin: str = parameter(
        "",
        "Name of the only progress checker, in parameter files of Humble; the list counts where empty.",
        read_only=True,
    )


class ControllerServer(ManagedNode):
    """Server of ``follow_path`` that publishes ``cmd_vel``."""

    def __init__(
        self, node_name: str = "controller_server", costmap_arguments: Sequence[str] = (), **kwargs: Any
    ) -> None:
        """Create the server; ``costmap_arguments`` are those of ROS for its costmap's node alone."""
        super().__init__(node_name, **kwargs)
        self._settings = declare(self, ControllerServerParameters, reconfigure=self._reconfigure)
        self._costmap = CostmapNode("local_costmap", self, costmap_arguments)
        self._contained = ContainedNode(self._costmap)
        self.add_managed_entity(self._contained)
        self._plugins: dict[str, dict[str, Any]] = {}
        self._velocity = np.zeros(3)
        self._current: Any = None
        self._pursuit: _Pursuit | None = None
        self._waiting_since: float | None = None

    def _reconfigure(self, parameters: ControllerServerParameters) -> None:
        """Use another tolerance and timeout from the next goal on."""
        self._settings = parameters

    def configure(self) -> None:
        """Make controllers and checkers and serve."""
        from geometry_msgs.msg import Twist, TwistStamped
        from nav2_msgs.action import FollowPath as FollowPathAction
        from nav2_msgs.msg import SpeedLimit
        from nav_msgs.msg import Odometry, Path

        declare_without_effect(self, _WITHOUT_EFFECT)
        maker = ExtensionMaker(
            self, replace(self._costmap.extension_context, frequency=self._settings.controller_frequency)
        )
        kinds: tuple[tuple[str, Kind[Any], str], ...] = (
            ("controller_plugins", CONTROLLERS, "nav2_mppi_controller::MPPIController"),
            ("goal_checker_plugins", GOAL_CHECKERS, "nav2_controller::SimpleGoalChecker"),
            ("progress_checker_plugins", PROGRESS_CHECKERS, "nav2_controller::SimpleProgressChecker"),
            ("path_handler_plugins", PATH_HANDLERS, "nav2_controller::FeasiblePathHandler"),
        )
        for group, kind, default in kinds:
            names = getattr(self._settings, group)
            if kind is PROGRESS_CHECKERS and self._settings.progress_checker_plugin:
                names = (self._settings.progress_checker_plugin,)
            self._plugins[group] = {name: maker.make(kind, name, default) for name in names}
        shown = [(name, one) for name, plugin in self._plugins["controller_plugins"].items() for one in plugin.outputs]
        self._shown = ControllerOutputs(self, shown)
        controllers = map(type, self._plugins["controller_plugins"].values())
        self._compiled = warm_up_in_background("daidalos.navigation", self.get_logger(), controllers)
        self._command = self.create_publisher(
            TwistStamped if self._settings.enable_stamped_cmd_vel else Twist, "cmd_vel", 1
        )
        self._local_plan = self.create_publisher(Path, "local_plan", 1)
        self.create_subscription(Odometry, self._settings.odom_topic, self._on_odometry, 10)
        self.create_subscription(SpeedLimit, self._settings.speed_limit_topic, self._on_speed_limit, 10)
        self.serve_action(FollowPathAction, "follow_path", self._follow)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop the robot and abort the goal."""
        self._stop()
        return super().on_deactivate(state)

    def _on_odometry(self, message: Any) -> None:
        p = self._settings
        least = (p.min_x_velocity_threshold, p.min_y_velocity_threshold, p.min_theta_velocity_threshold)
        velocity = velocity_of(message.twist.twist)
        self._velocity = np.where(np.abs(velocity) < least, 0.0, velocity)

    def _on_speed_limit(self, message: Any) -> None:
        """Pass a limit on to all controllers; one that is negative or not finite is refused."""
        limit = message.speed_limit
        if not 0.0 <= limit < np.inf:
            self.get_logger().error(f"a speed limit must not be negative, but is {limit:g}; the last one stays")
            return
        for controller in self._plugins["controller_plugins"].values():
            controller.set_speed_limit(limit, percentage=message.percentage)

    async def _follow(self, goal_handle: Any) -> Any:
        from nav2_msgs.action import FollowPath as FollowPathAction

        result = FollowPathAction.Result()
        self._current = goal_handle
        self._waiting_since = None
        try:
            await self._compiled
            await self._costmap.until_current(self, self._settings.costmap_update_timeout)
            if self._goes_on(goal_handle):
                self._pursuit = self._take_up(goal_handle.request)
            with Cycle(self, self._settings.controller_frequency) as cycle:
                while self._goes_on(goal_handle) and self._drive_or_wait(goal_handle):
                    await cycle.next()
            replaced = self._current is not goal_handle
        finally:
            if self._current is goal_handle:
                self._stop()
        if not goal_handle.is_active:
            return result
        if goal_handle.is_cancel_requested:
            goal_handle.canceled()
        elif replaced:
            goal_handle.abort()  # the robot does not stop for that
            result.error_msg = "preempted by another path"
        else:
            goal_handle.succeed()
        return result

    def _goes_on(self, goal_handle: Any) -> bool:
        """Return whether a goal is neither cancelled nor aborted nor replaced."""
        return self._current is goal_handle and not goal_handle.is_cancel_requested

    def _take_up(self, request: Any) -> _Pursuit:
        """Return the pursuit of a path; it goes on where a running one by the same plugins is."""
        path = path_array(request.path)
        plugins = (request.controller_id, request.goal_checker_id, request.progress_checker_id)
        running = self._pursuit
        if running is not None and running.plugins == plugins:
            task = running.task
            task.replan(path, new_goal=not np.allclose(path[-1:], running.goal, atol=1e-3))
        else:
            task = FollowPath(
                self._named("controller_plugins", plugins[0]),
                self._named("goal_checker_plugins", plugins[1]),
                self._named("progress_checker_plugins", plugins[2]),
                self._settings.failure_tolerance,
                next(iter(self._plugins["path_handler_plugins"].values()), None),
            )
            task.start(path)
        return _Pursuit(task, plugins, request.path.header.frame_id or self._costmap.global_frame, path[-1])

    def _named(self, group: str, name: str) -> Any:
        plugins = self._plugins[group]
        found = plugins.get(name or next(iter(plugins)))
        if found is None:
            raise UnknownController(f"there is no '{name}' among {group}: {', '.join(plugins)}")
        return found

    def _drive_or_wait(self, goal_handle: Any) -> bool:
        """Make one cycle, in which the robot stands where its data are too old; False when the goal is reached.

        Raises
        ------
        CostmapOutdated, TransformFailed
            They have been too old for ``costmap_update_timeout``.
        """
        now = self.get_clock().now().nanoseconds * 1e-9
        try:
            self._costmap.require_current()
            goes_on = self._drive(goal_handle)
        except (CostmapOutdated, TransformFailed) as problem:
            self._publish_velocity(np.zeros(3))
            self._waiting_since = now if self._waiting_since is None else min(self._waiting_since, now)
            if now - self._waiting_since >= self._settings.costmap_update_timeout:
                raise
            self.get_logger().warning(f"the robot waits: {problem}", throttle_duration_sec=1.0)
            return True
        self._waiting_since = None
        return goes_on

    def _drive(self, goal_handle: Any) -> bool:
        """Make one cycle; False when the goal is reached."""
        assert self._pursuit is not None
        pose = self._costmap.pose_of(self._costmap.base_frame)
        plan_frame = self._costmap.pose_of(self._pursuit.frame)
        with self._costmap.lock:
            layered = self._costmap.layered
            assert layered is not None
            step = self._pursuit.task.step(
                pose,
                self._velocity,
                layered.costmap,
                self.get_clock().now().nanoseconds * 1e-9,
                plan_frame=plan_frame,
                circumscribed_cost=layered.circumscribed_cost(self._costmap.footprint),
            )
        self._publish_velocity(step.velocity * self._share_of_speed())
        self._shown.publish(
            self._pursuit.plugins[0] or self._settings.controller_plugins[0], self._costmap.global_frame
        )
        self._tell(goal_handle, step)
        return not step.done

    def _share_of_speed(self) -> float:
        """Return the share of the speed for the age of the data: less and less from half of the allowed age on."""
        assert self._pursuit is not None
        age = self._costmap.age_of_data(self._costmap.base_frame, self._pursuit.frame)
        return float(np.clip(2.0 * (1.0 - age), 0.0, 1.0))

    def _tell(self, goal_handle: Any, step: Any) -> None:
        from nav2_msgs.action import FollowPath as FollowPathAction

        speed = float(np.hypot(*self._velocity[:2]))
        goal_handle.publish_feedback(
            FollowPathAction.Feedback(distance_to_goal=float(step.distance_to_goal), speed=speed)
        )
        if self._local_plan.handle.has_subscribers:
            stamp = self.get_clock().now().to_msg()
            self._local_plan.publish(path_message(step.path, self._costmap.global_frame, stamp))

    def _stop(self) -> None:
        """Follow no path, and stop the robot."""
        self._current = self._pursuit = None
        self._publish_velocity(np.zeros(3))

    def _publish_velocity(self, velocity: Any) -> None:
        frame = self._costmap.base_frame if self._settings.enable_stamped_cmd_vel else None
        self._command.publish(twist_message(velocity, frame, self.get_clock().now().to_msg()))

    def destroy_node(self) -> None:
        """Stop the robot, and destroy the node with its costmap."""
        if self._current is not None:
            self._stop()
        self._contained.destroy()
        super().destroy_node()
