"""`bt_navigator`: navigates to poses by a behavior tree."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from py_trees.common import Status
from rclpy.action import ActionClient
from rclpy.lifecycle import LifecycleState, TransitionCallbackReturn
from rclpy.time import Time
from tf2_ros import Buffer, TransformException, TransformListener

from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.paths import path_length
from daidalos.navigation.trees.action_node import RECOVERIES
from daidalos.navigation.trees.behavior_tree import DEFAULT_TREE, BehaviorTree
from daidalos.navigation.trees.blackboard import Blackboard
from daidalos.nodes.conversions import path_array, pose2_of_transform, pose_stamped
from daidalos.nodes.cycles import Cycle
from daidalos.nodes.managed import ManagedNode
from daidalos.nodes.nav2_bt_navigator._navigation import Navigation
from daidalos.nodes.nav2_bt_navigator._tasks import GraphServices
from daidalos.nodes.parameters import declare


@dataclass(frozen=True)
class BtNavigatorParameters(Parameters):
    """Parameters of the node, by their Nav2 names."""

    global_frame: str = parameter("map", "Frame of goals and feedback.", not_empty=True, read_only=True)
    robot_base_frame: str = parameter("base_link", "Frame of the robot's base.", not_empty=True, read_only=True)
    bt_loop_duration: int = parameter(50, "Time between two ticks of the tree.", unit="ms", minimum=1)
    default_nav_to_pose_bt_xml: str = parameter("", "File of the behaviour tree; empty for the built-in one.")


class BtNavigator(ManagedNode):
    """Server of ``navigate_to_pose`` that also accepts ``goal_pose``; parameters are Nav2's."""

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

    @property
    def _tree_file(self) -> str:
        return self._settings.default_nav_to_pose_bt_xml or str(DEFAULT_TREE)

    def configure(self) -> None:
        """Read the default tree and serve."""
        from geometry_msgs.msg import PoseStamped
        from nav2_msgs.action import NavigateToPose

        self._services = GraphServices(self)
        BehaviorTree.load(Path(self._tree_file), self._services)  # so that a faulty one is known at once
        self.serve_action(NavigateToPose, "navigate_to_pose", self._navigate, self._refusal)
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

    def _refusal(self, request: Any) -> str:
        frame = request.pose.header.frame_id
        if (
            frame
            and frame != self._settings.global_frame
            and not self._buffer.can_transform(self._settings.global_frame, frame, Time())
        ):
            return f"the frame '{frame}' is not known"
        return ""

    def _on_goal_pose(self, pose: Any) -> None:
        from nav2_msgs.action import NavigateToPose

        if not self.is_active:
            self.get_logger().info("a goal came before the navigator is active; it is driven to then")
            self._early_pose = pose
            return
        self._self_client.send_goal_async(NavigateToPose.Goal(pose=pose))

    async def _navigate(self, goal_handle: Any) -> Any:
        from nav2_msgs.action import NavigateToPose

        result = NavigateToPose.Result()
        goal = goal_handle.request.pose
        self.get_logger().info(
            f"driving to ({goal.pose.position.x:.2f}, {goal.pose.position.y:.2f}) in {goal.header.frame_id}"
        )
        if self._navigation is not None:
            self._navigation.replace_goal(goal_handle, NavigateToPose.Result(error_msg="replaced by another goal"))
            return await self._navigation.ended
        file = Path(goal_handle.request.behavior_tree or self._tree_file)
        navigation = Navigation(goal_handle, BehaviorTree.load(file, self._services), self.get_clock().now())
        self._navigation = navigation
        try:
            status = await self._run(navigation)
            self._report(status, navigation, result)
            navigation.end(status, result)
        finally:
            navigation.ended.cancel()  # unless it is done
            if self._navigation is navigation:
                self._navigation = None
        return result

    async def _run(self, navigation: Navigation) -> Status:
        """Tick the tree until it ends or the goal is cancelled."""
        with Cycle(self, 1000.0 / self._settings.bt_loop_duration) as cycle:
            while (status := navigation.tick()) == Status.RUNNING:
                self._publish_feedback(navigation)
                await cycle.next()
        return status

    def _publish_feedback(self, navigation: Navigation) -> None:
        from nav2_msgs.action import NavigateToPose

        try:
            found = self._buffer.lookup_transform(self._settings.global_frame, self._settings.robot_base_frame, Time())
        except TransformException:
            return
        path = navigation.blackboard.get("path")
        pose = pose2_of_transform(found.transform)
        navigation.goal_handle.publish_feedback(
            NavigateToPose.Feedback(
                current_pose=pose_stamped(pose, self._settings.global_frame, found.header.stamp),
                navigation_time=(self.get_clock().now() - navigation.begun).to_msg(),
                number_of_recoveries=int(navigation.blackboard.get(RECOVERIES, 0)),
                distance_remaining=0.0 if path is None else _remaining(path_array(path), pose),
            )
        )

    def _report(self, status: Status, navigation: Navigation, result: Any) -> None:
        """Log how a navigation ended, and set why it failed in its result."""
        if status == Status.SUCCESS:
            self.get_logger().info("the goal is reached")
        elif status == Status.FAILURE:
            result.error_code, result.error_msg = _reason(navigation.blackboard)
            self.get_logger().error(f"the goal is given up: {result.error_msg}")
        else:
            self.get_logger().info("the goal was cancelled")


def _reason(blackboard: Blackboard) -> tuple[int, str]:
    """Return the error code of the action that failed, as Nav2's results number it, and why it failed."""
    from nav2_msgs.action import ComputePathToPose, FollowPath

    for action, kind in (("compute_path", ComputePathToPose.Result), ("follow_path", FollowPath.Result)):
        text = blackboard.get(f"{action}_error_msg")
        if text:
            name = str(blackboard.get(f"{action}_error_code", "UNKNOWN"))
            return int(getattr(kind, name, kind.UNKNOWN)), str(text)
    return 0, "no recovery helped"


def _remaining(path: Any, pose: Any) -> float:
    """Return the length [m] of a path (n, 3) from where the robot is."""
    nearest = int(np.argmin(np.hypot(*(path[:, :2] - pose[:2]).T)))
    return float(path_length(path[nearest:]))
