"""`bt_navigator`: drives to poses by a behaviour tree."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
from py_trees.common import Status
from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from rclpy.time import Time
from tf2_ros import Buffer, TransformException, TransformListener

from daidalos.navigation.paths import path_length
from daidalos.navigation.trees.action.action_node import RECOVERIES
from daidalos.navigation.trees.behavior_tree import DEFAULT_TREE, BehaviorTree
from daidalos.navigation.trees.blackboard import Blackboard
from daidalos.navigation.trees.errors import TreeError
from daidalos.nodes.conversions import path_array, pose2_of_transform, pose_stamped
from daidalos.nodes.cycles import Cycle
from daidalos.nodes.nav2_bt_navigator._tasks import GraphServices
from daidalos.nodes.runner import run


class BtNavigator(LifecycleNode):
    """Serves ``navigate_to_pose`` and listens to ``goal_pose``; parameters are Nav2's."""

    def __init__(self, node_name: str = "bt_navigator", **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        self._map_frame = self.declare_parameter("global_frame", "map").value
        self._base_frame = self.declare_parameter("robot_base_frame", "base_link").value
        self._loop_ms = self.declare_parameter("bt_loop_duration", 50).value
        self._tree_file = self.declare_parameter("default_nav_to_pose_bt_xml", "").value or str(DEFAULT_TREE)
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)
        self._services = GraphServices(self)
        self._current: Any = None
        self._blackboard: Blackboard | None = None
        self._waiting: list[Any] = []
        self._last_result: Any = None
        self._early_pose: Any = None

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Read the default tree and serve."""
        from geometry_msgs.msg import PoseStamped
        from nav2_msgs.action import NavigateToPose

        BehaviorTree.load(Path(self._tree_file), self._services)  # so that a faulty one is known at once
        self._server = ActionServer(
            self,
            NavigateToPose,
            "navigate_to_pose",
            self._navigate,
            goal_callback=self._on_goal,
            cancel_callback=lambda goal: CancelResponse.ACCEPT,
        )
        self._self_client = ActionClient(self, NavigateToPose, "navigate_to_pose")
        self.create_subscription(PoseStamped, "goal_pose", self._on_goal_pose, 10)
        return super().on_configure(state)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Begin to navigate, first to where somebody clicked too early."""
        answer = super().on_activate(state)
        pose, self._early_pose = self._early_pose, None
        if pose is not None:
            self._when_active = self.create_timer(0.01, lambda: self._send_early(pose))
        return answer

    def _send_early(self, pose: Any) -> None:
        if self.current_state.label == "active":
            self.destroy_timer(self._when_active)
            self._on_goal_pose(pose)

    def _on_goal(self, request: Any) -> GoalResponse:
        if self.current_state.label != "active":
            self.get_logger().warning("a goal was rejected: the navigator is not active")
            return GoalResponse.REJECT
        frame = request.pose.header.frame_id
        if frame and frame != self._map_frame and not self._buffer.can_transform(self._map_frame, frame, Time()):
            self.get_logger().warning(f"a goal was rejected: the frame '{frame}' is not known")
            return GoalResponse.REJECT
        return GoalResponse.ACCEPT

    def _on_goal_pose(self, pose: Any) -> None:
        from nav2_msgs.action import NavigateToPose

        if self.current_state.label != "active":
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
        if self._current is not None and self._blackboard is not None:
            return await self._take_over(goal_handle, result)
        blackboard = Blackboard()
        blackboard.set("goal", goal)
        try:
            file = goal_handle.request.behavior_tree or self._tree_file
            tree = BehaviorTree.load(Path(file), self._services, blackboard)
        except TreeError as error:
            self.get_logger().error(str(error))
            goal_handle.abort()
            result.error_msg = str(error)
            return result
        self._current, self._blackboard = goal_handle, blackboard
        status = await self._run(tree, blackboard)
        last, self._current, self._blackboard = self._current, None, None
        self._finish(last, status, blackboard, result)
        self._wake_waiting()
        return result

    async def _take_over(self, goal_handle: Any, result: Any) -> Any:
        """Give the running tree another goal; this one ends with it."""
        from rclpy.task import Future

        previous, self._current = self._current, goal_handle
        assert self._blackboard is not None
        self._blackboard.set("goal", goal_handle.request.pose)
        self._blackboard.set(RECOVERIES, 0)
        if previous.is_active:
            previous.abort(type(result)(error_msg="replaced by another goal"))
        ended = Future()
        self._waiting.append(ended)
        await ended
        return self._last_result

    def _wake_waiting(self) -> None:
        waiting, self._waiting = self._waiting, []
        for future in waiting:
            future.set_result(None)

    async def _run(self, tree: BehaviorTree, blackboard: Blackboard) -> Status:
        """Tick the tree until it ends or the goal is cancelled."""
        begun = self.get_clock().now()
        with Cycle(self, 1000.0 / self._loop_ms) as cycle:
            while True:
                if self._current.is_cancel_requested:
                    tree.halt()
                    return Status.INVALID
                status = tree.tick()
                if status != Status.RUNNING:
                    return status
                self._tell(begun, blackboard)
                await cycle.next()

    def _tell(self, begun: Any, blackboard: Blackboard) -> None:
        from nav2_msgs.action import NavigateToPose

        try:
            found = self._buffer.lookup_transform(self._map_frame, self._base_frame, Time())
        except TransformException:
            return
        path = blackboard.get("path")
        pose = pose2_of_transform(found.transform)
        self._current.publish_feedback(
            NavigateToPose.Feedback(
                current_pose=pose_stamped(pose, self._map_frame, found.header.stamp),
                navigation_time=(self.get_clock().now() - begun).to_msg(),
                number_of_recoveries=int(blackboard.get(RECOVERIES, 0)),
                distance_remaining=0.0 if path is None else _remaining(path_array(path), pose),
            )
        )

    def _finish(self, goal_handle: Any, status: Status, blackboard: Blackboard, result: Any) -> None:
        self._last_result = result
        if status == Status.INVALID:
            goal_handle.canceled()
            self.get_logger().info("the goal was cancelled")
        elif status == Status.SUCCESS:
            goal_handle.succeed()
            self.get_logger().info("the goal is reached")
        else:
            result.error_code, result.error_msg = _reason(blackboard)
            goal_handle.abort()
            self.get_logger().error(f"the goal is given up: {result.error_msg}")


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


def main() -> int:
    """Run the node."""
    return run(BtNavigator)


if __name__ == "__main__":
    sys.exit(main())
