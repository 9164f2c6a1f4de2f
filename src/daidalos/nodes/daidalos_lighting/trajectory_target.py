"""`trajectory_target`: publishes where a trajectory ends before it passes it on to the arm's controller."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from action_msgs.msg import GoalStatus
from control_msgs.action import FollowJointTrajectory
from geometry_msgs.msg import PointStamped
from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.task import Future
from rclpy.time import Time
from sensor_msgs.msg import JointState
from std_msgs.msg import String

from daidalos.common.errors import UserError
from daidalos.common.parameters import Parameters, parameter
from daidalos.common.suggestions import hint
from daidalos.description.kinematics import KinematicTree
from daidalos.nodes.description_files import parse_description
from daidalos.nodes.parameters import declare
from daidalos.nodes.qos import LATCHED
from daidalos.nodes.runner import run


@dataclass(frozen=True)
class TrajectoryTargetParameters(Parameters):
    """Parameters of ``trajectory_target``."""

    action: str = parameter(
        "joint_trajectory_controller/follow_joint_trajectory", "Action of the arm's controller.", not_empty=True
    )
    lead: float = parameter(
        1.0, "Time between the target's publication and the beginning of the movement.", unit="s", minimum=0.0
    )
    tip_frame: str = parameter("tool0", "Link whose origin is the target.", not_empty=True)


class TrajectoryTarget(Node):
    """Node that takes ``trajectory_target/follow_joint_trajectory``, publishes ``target`` and passes the goal on.

    A trajectory is refused while the arm's description is not known, or where it has other joints or no finite end. A
    newer trajectory takes the place of one that still waits; a cancelled one that waits is not passed on.
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("trajectory_target", **kwargs)
        self._settings = settings = declare(self, TrajectoryTargetParameters)
        group = ReentrantCallbackGroup()
        self._tree: KinematicTree | None = None
        self._positions: dict[str, float] = {}
        self._waiting: Future | None = None
        self._targets = self.create_publisher(PointStamped, "target", LATCHED)
        self.create_subscription(String, "robot_description", self._take_description, LATCHED)
        self.create_subscription(JointState, "joint_states", self._take_joints, 10)
        self._client = ActionClient(self, FollowJointTrajectory, settings.action, callback_group=group)
        self._passed: dict[bytes, Any] = {}
        self._server = ActionServer(
            self,
            FollowJointTrajectory,
            "trajectory_target/follow_joint_trajectory",
            execute_callback=self._execute,
            goal_callback=self._check,
            cancel_callback=self._cancel,
            callback_group=group,
        )

    def _take_description(self, message: String) -> None:
        try:
            self._tree = KinematicTree(parse_description(message.data, "robot_description"))
        except UserError as error:
            self._tree = None
            self.get_logger().error(str(error))

    def _take_joints(self, message: JointState) -> None:
        self._positions.update(zip(message.name, message.position, strict=False))

    def _check(self, goal: Any) -> GoalResponse:
        problem = self._problem(goal)
        if problem:
            self.get_logger().error(f"trajectory refused: {problem}")
            return GoalResponse.REJECT
        return GoalResponse.ACCEPT

    def _problem(self, goal: Any) -> str:
        tree, trajectory = self._tree, goal.trajectory
        if tree is None:
            return "the topic robot_description has not come"
        if self._settings.tip_frame not in tree.link_names:
            tip = self._settings.tip_frame
            return f"the robot has no link '{tip}'{hint(tip, tree.link_names)}"
        for name in trajectory.joint_names:
            if name not in tree.joint_names:
                return f"the robot has no joint '{name}'{hint(name, tree.joint_names)}"
        last = trajectory.points[-1].positions if trajectory.points else ()
        if not trajectory.joint_names or len(last) != len(trajectory.joint_names) or not np.isfinite(last).all():
            return "its last point needs a finite position of each joint"
        if not self._client.server_is_ready():
            return f"there is no action '{self._settings.action}'"
        return ""

    def _cancel(self, handle: Any) -> CancelResponse:
        passed = self._passed.get(bytes(handle.goal_id.uuid))
        if passed is not None:
            passed.cancel_goal_async()
        elif self._waiting is not None and not self._waiting.done():
            self._waiting.set_result(False)
        return CancelResponse.ACCEPT

    async def _execute(self, handle: Any) -> Any:
        """Show the target, wait, pass the goal on and return what becomes of it."""
        goal = handle.request
        self._targets.publish(self._target(goal.trajectory))
        if not await self._wait(goal.trajectory):
            if handle.is_cancel_requested:
                handle.canceled()
            else:
                handle.abort()
            return _failed("the trajectory was cancelled, or replaced by a newer one, before the arm moved")
        passed = await self._client.send_goal_async(goal, lambda one: handle.publish_feedback(one.feedback))
        if not passed.accepted:
            handle.abort()
            return _failed(f"'{self._settings.action}' refuses the trajectory")
        key = bytes(handle.goal_id.uuid)
        self._passed[key] = passed
        if handle.is_cancel_requested:
            passed.cancel_goal_async()
        try:
            answer = await passed.get_result_async()
        finally:
            del self._passed[key]
        if answer.status == GoalStatus.STATUS_SUCCEEDED:
            handle.succeed()
        elif handle.is_cancel_requested:
            handle.canceled()
        else:
            handle.abort()
        return answer.result

    async def _wait(self, trajectory: Any) -> bool:
        """Wait until the arm may move; return False where the trajectory is not to be passed on.

        A trajectory that begins later than after the lead need not wait; one that would begin earlier begins after it.
        """
        if self._waiting is not None and not self._waiting.done():
            self._waiting.set_result(False)
        clock = self.get_clock()
        start = Time.from_msg(trajectory.header.stamp, clock_type=clock.clock_type)
        earliest = clock.now() + Duration(seconds=self._settings.lead)
        if start.nanoseconds and start >= earliest:
            return True
        waiting = self._waiting = Future()

        def end() -> None:
            timer.cancel()
            if not waiting.done():
                waiting.set_result(True)

        timer = self.create_timer(max(self._settings.lead, 1e-6), end)
        try:
            is_due = await waiting
        finally:
            self.destroy_timer(timer)
        if start.nanoseconds:
            trajectory.header.stamp = self.get_clock().now().to_msg()
        return bool(is_due)

    def _target(self, trajectory: Any) -> PointStamped:
        tree = self._tree
        assert tree is not None
        last = dict(zip(trajectory.joint_names, trajectory.points[-1].positions, strict=True))
        joints = np.array([last.get(name, self._positions.get(name, 0.0)) for name in tree.joint_names])
        translations, _ = tree.link_poses(joints)
        message = PointStamped()
        message.header.frame_id = tree.link_names[0]
        message.header.stamp = self.get_clock().now().to_msg()
        place = translations[tree.link_names.index(self._settings.tip_frame)].tolist()
        message.point.x, message.point.y, message.point.z = place
        return message


def _failed(problem: str) -> Any:
    return FollowJointTrajectory.Result(error_code=FollowJointTrajectory.Result.INVALID_GOAL, error_string=problem)


def main() -> int:
    """Run the node."""
    return run(TrajectoryTarget)
