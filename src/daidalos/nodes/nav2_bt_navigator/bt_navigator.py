"""`bt_navigator`: navigates to poses by a behavior tree."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from py_trees.common import Status
from rclpy.action import ActionClient
from rclpy.lifecycle import LifecycleState, TransitionCallbackReturn
from tf2_ros import Buffer, TransformListener

from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.paths import path_length
from daidalos.navigation.trees.action_node import RECOVERIES
from daidalos.navigation.trees.behavior_tree import DEFAULT_TREE, THROUGH_POSES_TREE, BehaviorTree
from daidalos.navigation.trees.blackboard import Blackboard
from daidalos.navigation.trees.errors import TreeError
from daidalos.nodes.conversions import path_array, pose2_of
from daidalos.nodes.cycles import Cycle
from daidalos.nodes.managed import ManagedNode
from daidalos.nodes.nav2_bt_navigator._navigation import Navigation
from daidalos.nodes.nav2_bt_navigator._tasks import GraphServices
from daidalos.nodes.parameters import declare, declare_one, declare_without_effect

NAVIGATORS = {
    "navigate_to_pose": ("nav2_bt_navigator::NavigateToPoseNavigator", "nav2_bt_navigator/NavigateToPoseNavigator"),
    "navigate_through_poses": (
        "nav2_bt_navigator::NavigateThroughPosesNavigator", "nav2_bt_navigator/NavigateThroughPosesNavigator"
    ),
}  # fmt: skip
"""Names of navigators, which are those of their actions, with the classes that Nav2's files give them."""

_WITHOUT_EFFECT = {
    "plugin_lib_names": "all built-in tree nodes are known, and those of other packages by their entry points",
    "default_server_timeout": "a tree waits for its servers without blocking",
    "wait_for_service_timeout": "a tree waits for its servers without blocking",
    "action_server_result_timeout": "results are kept as long as the server runs",
    "always_reload_bt_xml": "files of trees are read anew for each goal",
    "bond_heartbeat_period": "there are no bonds; the lifecycle manager asks for states",
    "service_introspection_mode": "service introspection is configured by each service's own parameters",
}
"""Parameters of some of Nav2's releases that do nothing here, with the reason."""


@dataclass(frozen=True)
class BtNavigatorParameters(Parameters):
    """Parameters of the node, by their Nav2 names."""

    global_frame: str = parameter("map", "Frame of goals and feedback.", not_empty=True, read_only=True)
    robot_base_frame: str = parameter("base_link", "Frame of the robot's base.", not_empty=True, read_only=True)
    odom_topic: str = parameter("odom", "Topic of the odometry.", not_empty=True, read_only=True)
    bt_loop_duration: int = parameter(50, "Time between two ticks of the tree.", unit="ms", minimum=1)
    default_nav_to_pose_bt_xml: str = parameter("", "File of the behaviour tree; empty for the built-in one.")
    default_nav_through_poses_bt_xml: str = parameter(
        "", "File of the behaviour tree for several poses; empty for the built-in one."
    )
    navigators: tuple[str, ...] = parameter(
        tuple(NAVIGATORS), "Names of the navigators.", choices=tuple(NAVIGATORS), unique=True, read_only=True
    )
    error_code_names: tuple[str, ...] = parameter(
        ("compute_path_error_code", "follow_path_error_code", "compute_route_error_code"),
        "Names on the blackboard of the error codes that a failed goal reports, the first that is set.",
    )
    error_code_name_prefixes: tuple[str, ...] = parameter(
        (), "The same without their ends '_error_code'; they come before error_code_names."
    )

    @property
    def all_error_code_names(self) -> tuple[str, ...]:
        """Names on the blackboard of the error codes that a failed goal reports."""
        return tuple(f"{one}_error_code" for one in self.error_code_name_prefixes) + self.error_code_names


class BtNavigator(ManagedNode):
    """Server of ``navigate_to_pose`` and ``navigate_through_poses`` that also accepts ``goal_pose``."""

    def __init__(self, node_name: str = "bt_navigator", **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        self._settings = declare(self, BtNavigatorParameters, reconfigure=self._reconfigure)
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)
        self._navigation: Navigation | None = None
        self._early_pose: Any = None

    def _reconfigure(self, parameters: BtNavigatorParameters) -> None:
        """Use another tree and period from the next goal on."""
        self._settings = parameters

    def _tree_file(self, request: Any) -> Path:
        """Return the file of the tree for a goal."""
        p = self._settings
        if hasattr(request, "poses"):
            return Path(request.behavior_tree or p.default_nav_through_poses_bt_xml or THROUGH_POSES_TREE)
        return Path(request.behavior_tree or p.default_nav_to_pose_bt_xml or DEFAULT_TREE)

    def configure(self) -> None:
        """Read the default trees and serve."""
        from geometry_msgs.msg import PoseStamped
        from nav2_msgs.action import NavigateThroughPoses, NavigateToPose

        declare_without_effect(self, _WITHOUT_EFFECT)
        p = self._settings
        self._services = GraphServices(self, self._buffer, (p.global_frame, p.robot_base_frame), p.odom_topic)
        for name, action in (("navigate_to_pose", NavigateToPose), ("navigate_through_poses", NavigateThroughPoses)):
            if name not in p.navigators:
                continue
            declare_one(
                self, f"{name}.plugin", NAVIGATORS[name][0], "Class of the navigator.", choices=NAVIGATORS[name]
            )
            BehaviorTree.load(self._tree_file(action.Goal()), self._services)  # so that a faulty one is known at once
            self.serve_action(action, name, partial(self._navigate, action), partial(self._refusal, action))
        self._self_client = ActionClient(self, NavigateToPose, "navigate_to_pose")
        self.create_subscription(PoseStamped, "goal_pose", self._on_goal_pose, 10)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Start to navigate, first to a goal pose that came before the activation."""
        outcome = super().on_activate(state)
        pose, self._early_pose = self._early_pose, None
        if pose is not None and outcome == TransitionCallbackReturn.SUCCESS:
            self._on_goal_pose(pose)
        return outcome

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Abort the goal and halt its tree."""
        outcome = super().on_deactivate(state)
        if self._navigation is not None:
            self._navigation.tick()
            self._navigation = None
        return outcome

    def _refusal(self, action: Any, request: Any) -> str:
        """Return why a goal is rejected, an empty string where it is accepted."""
        running = self._navigation
        if running is not None and type(running.goal_handle.request) is not action.Goal:
            return "another navigator is busy"
        poses = request.poses if hasattr(request, "poses") else [request.pose]
        if not poses:
            return "there are no poses"
        for pose in poses:
            if self._services.pose_in(pose) is None:
                return f"the frame '{pose.header.frame_id}' is not known"
        return ""

    def _on_goal_pose(self, pose: Any) -> None:
        from nav2_msgs.action import NavigateToPose

        if not self.is_active:
            self.get_logger().info("a goal came before the navigator is active; it is driven to then")
            self._early_pose = pose
            return
        self._self_client.send_goal_async(NavigateToPose.Goal(pose=pose))

    async def _navigate(self, action: Any, goal_handle: Any) -> Any:
        result = action.Result()
        request = goal_handle.request
        poses = request.poses if hasattr(request, "poses") else [request.pose]
        goal, through = poses[-1], f" through {len(poses) - 1} poses" if len(poses) > 1 else ""
        self.get_logger().info(
            f"driving to ({goal.pose.position.x:.2f}, {goal.pose.position.y:.2f}) in {goal.header.frame_id}{through}"
        )
        if self._navigation is not None:
            self._navigation.replace_goal(goal_handle, action.Result(error_msg="replaced by another goal"))
            return await self._navigation.ended
        tree = BehaviorTree.load(self._tree_file(request), self._services)
        navigation = Navigation(goal_handle, tree, self.get_clock().now())
        self._navigation = navigation
        try:
            status = await self._run(navigation, action)
            self._report(status, navigation, result)
            navigation.end(status, result)
        finally:
            navigation.ended.cancel()  # unless it is done
            if self._navigation is navigation:
                self._navigation = None
        return result

    async def _run(self, navigation: Navigation, action: Any) -> Status:
        """Tick the tree until it ends or the goal is cancelled."""
        with Cycle(self, 1000.0 / self._settings.bt_loop_duration) as cycle:
            try:
                while (status := navigation.tick()) == Status.RUNNING:
                    self._publish_feedback(navigation, action)
                    await cycle.next()
            except TreeError as error:
                navigation.halt()
                navigation.fault = str(error)
                return Status.FAILURE
        return status

    def _publish_feedback(self, navigation: Navigation, action: Any) -> None:
        pose = self._services.robot_pose_stamped()
        if pose is None:
            return
        path = navigation.blackboard.get("path")
        feedback = action.Feedback(
            current_pose=pose,
            navigation_time=(self.get_clock().now() - navigation.begun).to_msg(),
            number_of_recoveries=int(navigation.blackboard.get(RECOVERIES, 0)),
            distance_remaining=0.0 if path is None else _remaining(path_array(path), pose2_of(pose.pose)),
        )
        if hasattr(feedback, "number_of_poses_remaining"):
            feedback.number_of_poses_remaining = navigation.poses_remaining
        navigation.goal_handle.publish_feedback(feedback)

    def _report(self, status: Status, navigation: Navigation, result: Any) -> None:
        """Log how a navigation ended, and set why it failed in its result."""
        if status == Status.SUCCESS:
            self.get_logger().info("the goal is reached")
        elif status == Status.FAILURE:
            reason = _reason(navigation.blackboard, self._settings.all_error_code_names)
            result.error_code, result.error_msg = (0, navigation.fault) if navigation.fault else reason
            self.get_logger().error(f"the goal is given up: {result.error_msg}")
        else:
            self.get_logger().info("the goal was cancelled")


def _reason(blackboard: Blackboard, names: tuple[str, ...]) -> tuple[int, str]:
    """Return the error code of the action that failed, as Nav2's results number it, and why it failed."""
    for name in names:
        code = blackboard.get(name)
        if code in (None, 0, "NONE"):
            continue
        number = getattr(code, "number", code)
        text = blackboard.get(f"{name.removesuffix('_code')}_msg")
        return number if isinstance(number, int) else 0, str(text or f"{name} is {code}")
    return 0, "no recovery helped"


def _remaining(path: Any, pose: Any) -> float:
    """Return the length [m] of a path (n, 3) from where the robot is."""
    nearest = int(np.argmin(np.hypot(*(path[:, :2] - pose[:2]).T)))
    return float(path_length(path[nearest:]))
