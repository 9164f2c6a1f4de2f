"""`move_base`: brings the robot to a goal, with ROS 1's parameters and topics."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node
from rclpy.time import Time
from tf2_ros import Buffer, TransformException, TransformListener

from daidalos.navigation.costmap.footprint import Footprint
from daidalos.nodes.action_results import set_error
from daidalos.nodes.conversions import pose2_of, pose2_of_transform, pose_stamped
from daidalos.nodes.move_base._driving import Driver, GoalFailed, Interrupted
from daidalos.nodes.move_base._parameters import SLOW, MoveBaseParameters, recoveries
from daidalos.nodes.move_base._servers import Servers
from daidalos.nodes.move_base._translation import translate
from daidalos.nodes.parameters import declare, declare_given, declare_without_effect
from daidalos.nodes.qos import LATCHED
from daidalos.nodes.runner import run
from daidalos.samples.fields import time_message

_WITHOUT_EFFECT = {
    "shutdown_costmaps": "the costmaps are always up to date",
    "restore_defaults": "defaults are restored by starting the node without parameters",
    "make_plan_clear_costmap": "plans for others leave the costmaps as they are",
    "make_plan_add_unreachable_goal": "a plan ends where the planner's tolerance allows",
}
"""Parameters of some of ROS 1's releases that do nothing here, with the reason."""
_NO_TURN_LIMIT = "a limit of the speed is one of the speed ahead; the controller's own limit of turns stays"
_NO_MEANING = "the planner or controller that stands for ROS 1's has nothing like it"


class MoveBase(Node):
    """Node with a planner, a controller, both costmaps and recoveries.

    The action `move_base` is one of `NavigateToPose`. Goals also come on `move_base_simple/goal` and
    `move_base/goal`, one at a time: a new one takes the place of the last.
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("move_base", **kwargs)
        from action_msgs.msg import GoalInfo, GoalStatus, GoalStatusArray
        from action_msgs.srv import CancelGoal
        from geometry_msgs.msg import PoseStamped
        from nav2_msgs.action import NavigateToPose
        from nav_msgs.srv import GetPlan
        from std_srvs.srv import Empty

        self._settings = p = declare(self, MoveBaseParameters, reconfigure=self._reconfigure)
        outer = self.get_namespace().rstrip("/")
        given = {name: one.value for name, one in self._parameter_overrides.items()}
        translation = translate(p, given, outer, self.resolve_topic_name("odom"))
        local, whole = (translation.nodes[f"{name}/{name}"] for name in ("local_costmap", "global_costmap"))
        self._frames = whole["global_frame"], whole["robot_base_frame"]
        outline = Footprint.from_parameters(local.get("footprint", "[]"), local.get("robot_radius", 0.1), 0.0)
        behaviours = recoveries(p, given, outline.circumscribed_radius)
        used = translation.used.union(*(one.parameters for one in behaviours))
        turn_limits = {f"{one.name}.limited_rot_speed": _NO_TURN_LIMIT for one in behaviours if one.type == SLOW}
        no_meaning = dict.fromkeys(sorted(translation.without_effect), _NO_MEANING)
        declare_without_effect(self, _WITHOUT_EFFECT | turn_limits | no_meaning)
        declare_given(self, used)
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)
        self._servers = Servers(self, translation)
        self._driver = Driver(self, behaviours, self._pose)
        self._current: Any = None
        name = f"{outer}/move_base"
        self._current_goal = self.create_publisher(PoseStamped, f"{name}/current_goal", LATCHED)
        self._feedback = self.create_publisher(PoseStamped, f"{name}/feedback", 10)
        self._result = self.create_publisher(GoalStatus, f"{name}/result", 10)
        self._status = self.create_publisher(GoalStatusArray, f"{name}/status", LATCHED)
        self._own = ActionClient(self, NavigateToPose, name)
        for topic in (f"{outer}/move_base_simple/goal", f"{name}/goal"):
            self.create_subscription(PoseStamped, topic, self._on_goal, 10)
        self.create_subscription(GoalStatusArray, f"{name}/_action/status", self._status.publish, LATCHED)
        self._cancel_client = self.create_client(CancelGoal, f"{name}/_action/cancel_goal")
        self.create_subscription(GoalInfo, f"{name}/cancel", self._on_cancel, 10)
        awaiting = ReentrantCallbackGroup()
        self.create_service(GetPlan, f"{name}/make_plan", self._on_make_plan, callback_group=awaiting)
        self.create_service(Empty, f"{name}/clear_costmaps", self._on_clear_costmaps, callback_group=awaiting)
        ActionServer(
            self, NavigateToPose, name, partial(self._execute, NavigateToPose), goal_callback=self._accept,
            cancel_callback=lambda goal: CancelResponse.ACCEPT,
        )  # fmt: skip

    def _reconfigure(self, parameters: MoveBaseParameters) -> None:
        self._settings = parameters

    def _pose(self) -> Any:
        """Return the robot's pose (x, y, yaw) in the global frame, None while it is not known."""
        try:
            return np.asarray(pose2_of_transform(self._buffer.lookup_transform(*self._frames, Time()).transform))
        except TransformException:
            return None

    def _accept(self, request: Any) -> GoalResponse:
        pose = pose2_of(request.pose.pose)
        reason = "" if np.isfinite(pose).all() else "its pose is not finite"
        if request.behavior_tree:
            reason = "it has a behaviour tree, which bt_navigator would run"
        if reason:
            self.get_logger().warning(f"a goal was rejected: {reason}")
        return GoalResponse.REJECT if reason else GoalResponse.ACCEPT

    def _on_goal(self, pose: Any) -> None:
        from nav2_msgs.action import NavigateToPose

        self._own.send_goal_async(NavigateToPose.Goal(pose=pose))

    def _on_cancel(self, goal: Any) -> None:
        from action_msgs.srv import CancelGoal

        self._cancel_client.call_async(CancelGoal.Request(goal_info=goal))

    async def _on_make_plan(self, request: Any, response: Any) -> Any:
        start = request.start if request.start.header.frame_id else None
        plan = await self._driver.plan(request.goal, start)
        if isinstance(plan, str):
            self.get_logger().warning(f"make_plan: {plan}")
        else:
            response.plan = plan
        return response

    async def _on_clear_costmaps(self, request: Any, response: Any) -> Any:
        await self._driver.clear_costmaps()
        return response

    async def _execute(self, action: Any, goal_handle: Any) -> Any:
        from action_msgs.msg import GoalInfo, GoalStatus

        result = action.Result()
        self._current = goal_handle
        goal = goal_handle.request.pose
        self._current_goal.publish(goal)
        begun_ns = self.get_clock().now().nanoseconds
        status = GoalStatus.STATUS_ABORTED
        try:
            await self._driver.go(
                goal, self._settings, lambda: self._is_wanted(goal_handle),
                lambda: self._tell(action, goal_handle, begun_ns),
            )  # fmt: skip
            status = GoalStatus.STATUS_SUCCEEDED
            goal_handle.succeed()
        except Interrupted:
            if goal_handle.is_cancel_requested:
                status = GoalStatus.STATUS_CANCELED
                goal_handle.canceled()
            elif goal_handle.is_active:
                set_error(result, GoalFailed("preempted by another goal"))
                goal_handle.abort()
        except GoalFailed as error:
            self.get_logger().error(f"the goal is given up: {error}")
            set_error(result, error)
            goal_handle.abort()
        self._result.publish(
            GoalStatus(goal_info=GoalInfo(goal_id=goal_handle.goal_id, stamp=time_message(begun_ns)), status=status)
        )
        return result

    def _is_wanted(self, goal_handle: Any) -> bool:
        return self._current is goal_handle and goal_handle.is_active and not goal_handle.is_cancel_requested

    def _tell(self, action: Any, goal_handle: Any, begun_ns: int) -> None:
        pose = self._pose()
        if pose is None:
            return
        now = self.get_clock().now()
        feedback = action.Feedback(
            current_pose=pose_stamped(pose, self._frames[0], now.to_msg()),
            number_of_recoveries=self._driver.recoveries,
            distance_remaining=self._driver.distance_left,
        )
        passed = time_message(now.nanoseconds - begun_ns)
        feedback.navigation_time.sec, feedback.navigation_time.nanosec = passed.sec, passed.nanosec
        goal_handle.publish_feedback(feedback)
        self._feedback.publish(feedback.current_pose)

    def destroy_node(self) -> None:
        """Stop the robot, and destroy the node with its servers."""
        self._current = None
        self._servers.destroy()
        super().destroy_node()


def main() -> int:
    """Run the node."""
    return run(MoveBase)
