"""`waypoint_follower`: drives to waypoints one after the other, and carries out a task at each."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from action_msgs.msg import GoalStatus
from rclpy.action import ActionClient
from rclpy.qos import qos_profile_sensor_data

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.contracts import Input, NavigationContext, WaypointTask
from daidalos.navigation.errors import NavigationError, TaskFailed
from daidalos.navigation.extensions import WAYPOINT_TASKS
from daidalos.nodes.conversions import pose2_of
from daidalos.nodes.cycles import Cycle
from daidalos.nodes.managed import ManagedNode
from daidalos.nodes.navigation_extensions import ExtensionMaker
from daidalos.nodes.parameters import declare, declare_without_effect

_DEFAULT_PLUGINS = {"wait_at_waypoint": "nav2_waypoint_follower::WaitAtWaypoint"}
_WITHOUT_EFFECT = {
    "action_server_result_timeout": "results are kept as long as the server runs",
    "bond_heartbeat_period": "there are no bonds; the lifecycle manager asks for states",
    "service_introspection_mode": "service introspection is configured by each service's own parameters",
}
"""Parameters of some of Nav2's releases that do nothing here, with the reason."""


@dataclass(frozen=True)
class WaypointFollowerParameters(Parameters):
    """Parameters of the node, by their Nav2 names."""

    loop_rate: int = parameter(20, "Cycles per second.", unit="Hz", minimum=1)
    stop_on_failure: bool = parameter(True, "Whether a waypoint that is missed ends the goal.")
    waypoint_task_executor_plugin: str = parameter(
        "wait_at_waypoint", "Name of the task at each waypoint.", not_empty=True, read_only=True
    )
    global_frame_id: str = parameter("map", "Frame in which places on the earth are given to the navigator.")


class WaypointFollower(ManagedNode):
    """Server of ``follow_waypoints`` and ``follow_gps_waypoints``."""

    def __init__(self, node_name: str = "waypoint_follower", **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        self._settings = declare(self, WaypointFollowerParameters, reconfigure=self._reconfigure)
        self._current: Any = None

    def _reconfigure(self, parameters: WaypointFollowerParameters) -> None:
        """Use another rate from the next goal on, and decide otherwise on missed waypoints at once."""
        self._settings = parameters

    def configure(self) -> None:
        """Make the task and serve."""
        from nav2_msgs.action import FollowGPSWaypoints, FollowWaypoints, NavigateToPose
        from robot_localization.srv import FromLL

        declare_without_effect(self, _WITHOUT_EFFECT)
        name = self._settings.waypoint_task_executor_plugin
        context = NavigationContext(frequency=float(self._settings.loop_rate))
        self._task: WaypointTask = ExtensionMaker(self, context).make(
            WAYPOINT_TASKS, name, _DEFAULT_PLUGINS.get(name, "")
        )
        for one in self._task.inputs:
            self._listen(one)
        self._navigator = ActionClient(self, NavigateToPose, "navigate_to_pose")
        self._from_ll = self.create_client(FromLL, "/fromLL")
        self.serve_action(
            FollowWaypoints, "follow_waypoints", self._follow, lambda goal: _refusal(goal, len(goal.poses))
        )
        self.serve_action(
            FollowGPSWaypoints,
            "follow_gps_waypoints",
            self._follow_gps,
            lambda goal: _refusal(goal, len(goal.gps_poses)),
        )

    def _listen(self, listened: Input) -> None:
        from sensor_msgs.msg import Image
        from std_msgs.msg import Empty

        if listened.type is type(None):
            self.create_subscription(Empty, listened.topic, lambda message: listened.take(), 1)
        else:
            self.create_subscription(
                Image,
                listened.topic,
                lambda message: listened.take(partial(_pixels_of, message)),
                qos_profile_sensor_data,
            )

    async def _follow(self, goal_handle: Any) -> Any:
        """Visit the waypoints of a goal; another goal replaces it."""
        from nav2_msgs.action import FollowWaypoints

        self._current = goal_handle
        with Cycle(self, float(self._settings.loop_rate)) as cycle:
            return await self._visit_all(goal_handle, FollowWaypoints, goal_handle.request.poses, cycle)

    async def _follow_gps(self, goal_handle: Any) -> Any:
        """Visit the places on the earth of a goal, which ``/fromLL`` converts; another goal replaces it."""
        from nav2_msgs.action import FollowGPSWaypoints

        self._current = goal_handle
        with Cycle(self, float(self._settings.loop_rate)) as cycle:
            poses = []
            for place in goal_handle.request.gps_poses:
                if self._is_over(goal_handle):
                    break
                poses.append(await self._pose_of(place, goal_handle, cycle))
            return await self._visit_all(goal_handle, FollowGPSWaypoints, poses, cycle)

    async def _pose_of(self, place: Any, goal_handle: Any, cycle: Cycle) -> Any:
        """Return the pose in the global frame of a place on the earth.

        Raises
        ------
        NavigationError
            Nobody serves ``/fromLL``, or the answer has no finite place.
        """
        from geometry_msgs.msg import PoseStamped
        from robot_localization.srv import FromLL

        pose = PoseStamped()
        pose.header.frame_id = self._settings.global_frame_id
        pose.header.stamp = self.get_clock().now().to_msg()
        pose.pose.orientation = place.orientation
        if not self._from_ll.service_is_ready():
            raise NavigationError(
                "the service /fromLL is not served: is robot_localization's navsat_transform running?"
            )
        answer = self._from_ll.call_async(FromLL.Request(ll_point=place.position))
        while not answer.done():
            if self._is_over(goal_handle):
                answer.cancel()
                return pose
            if not self._from_ll.service_is_ready():
                raise NavigationError("the service /fromLL stopped before it answered")
            await cycle.next()
        pose.pose.position = answer.result().map_point
        if not (math.isfinite(pose.pose.position.x) and math.isfinite(pose.pose.position.y)):
            at = f"latitude {place.position.latitude:g}, longitude {place.position.longitude:g}"
            raise NavigationError(f"/fromLL knows no place on the map for {at}")
        return pose

    async def _visit_all(self, goal_handle: Any, action: Any, poses: Sequence[Any], cycle: Cycle) -> Any:
        """Visit poses in the order of a goal of an action, and return its result."""
        result = action.Result()
        if not self._is_over(goal_handle):
            for index in _order(goal_handle.request, len(poses)):
                missed = await self._visit(goal_handle, action, index, poses[index], cycle)
                if self._is_over(goal_handle):
                    break
                if missed is not None:
                    result.missed_waypoints.append(missed)
                    if self._settings.stop_on_failure:
                        result.error_code = missed.error_code
                        result.error_msg = f"waypoint {index} was missed"
                        goal_handle.abort(result)
                        return result
        if not goal_handle.is_active:
            return result
        if goal_handle.is_cancel_requested:
            goal_handle.canceled()
        elif self._current is not goal_handle:
            result.error_msg = "replaced by other waypoints"
            goal_handle.abort(result)
        else:
            goal_handle.succeed()
        return result

    def _is_over(self, goal_handle: Any) -> bool:
        """Return whether a goal is cancelled, aborted or replaced."""
        is_active = goal_handle.is_active and not goal_handle.is_cancel_requested
        return not is_active or self._current is not goal_handle

    async def _visit(self, goal_handle: Any, action: Any, index: int, pose: Any, cycle: Cycle) -> Any | None:
        """Drive to a waypoint and carry out the task there; return the ``MissedWaypoint`` where that failed."""
        from nav2_msgs.msg import MissedWaypoint

        goal_handle.publish_feedback(action.Feedback(current_waypoint=index))
        code, reason = await self._drive(goal_handle, pose, cycle)
        if not self._is_over(goal_handle) and not reason:
            code, reason = await self._carry_out(goal_handle, index, pose, cycle)
        if not reason:
            return None
        self.get_logger().warning(f"waypoint {index} is missed: {reason}")
        return MissedWaypoint(index=index, goal=pose, error_code=code)

    async def _drive(self, goal_handle: Any, pose: Any, cycle: Cycle) -> tuple[int, str]:
        """Drive to a pose; return the error code and why it was not reached, empty where it was."""
        from nav2_msgs.action import FollowWaypoints, NavigateToPose

        unknown = int(FollowWaypoints.Result.UNKNOWN)
        if not self._navigator.server_is_ready():
            return unknown, "the action navigate_to_pose is not served"
        sent = self._navigator.send_goal_async(NavigateToPose.Goal(pose=pose))
        while not sent.done():  # also after a cancellation: a goal that is on its way must be taken back
            await cycle.next()
        handle = sent.result()
        if handle is None or not handle.accepted:
            return unknown, "navigate_to_pose rejected it"
        ended = handle.get_result_async()
        while not ended.done():
            if self._is_over(goal_handle):
                handle.cancel_goal_async()
                return unknown, "the goal is over"
            await cycle.next()
        answer = ended.result()
        if answer.status == GoalStatus.STATUS_SUCCEEDED:
            return 0, ""
        return int(answer.result.error_code) or unknown, answer.result.error_msg or "navigate_to_pose did not succeed"

    async def _carry_out(self, goal_handle: Any, index: int, pose: Any, cycle: Cycle) -> tuple[int, str]:
        """Carry out the task at a waypoint; return as `_drive` does."""
        from nav2_msgs.action import FollowWaypoints

        try:
            self._task.start(index, pose2_of(pose.pose), self._now)
            while not self._is_over(goal_handle) and not self._task.step(self._now):
                await cycle.next()
        except TaskFailed as error:
            return int(FollowWaypoints.Result.TASK_EXECUTOR_FAILED), str(error)
        return 0, ""

    @property
    def _now(self) -> float:
        return self.get_clock().now().nanoseconds * 1e-9


def _refusal(request: Any, count: int) -> str:
    """Return why a goal with a number of waypoints is rejected, an empty string where it is accepted."""
    if not count:
        return "there are no waypoints"
    if request.goal_index >= count:
        return f"goal_index {request.goal_index} is beyond the {count} waypoints"
    return ""


def _order(request: Any, count: int) -> list[int]:
    """Return the indices of a number of waypoints in the order of the visits."""
    every = list(range(count))
    return every[request.goal_index :] + every * int(request.number_of_loops)


def _pixels_of(message: Any) -> Array:
    """Return the pixels of an image: of colours as RGB, others as they are.

    Raises
    ------
    TaskFailed
        Its encoding or its size cannot be read.
    """
    from cv_bridge import CvBridge, CvBridgeError
    from cv_bridge.encodings import encoding

    try:
        is_grey = encoding(message.encoding).order in ("", "mono")
        pixels: Array = CvBridge().imgmsg_to_cv2(message, "passthrough" if is_grey else "rgb8")
    except (CvBridgeError, RuntimeError, ValueError, TypeError) as error:
        raise TaskFailed(f"the camera's image cannot be read: {error}") from error
    return pixels
