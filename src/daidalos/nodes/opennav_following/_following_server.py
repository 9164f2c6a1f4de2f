"""Following server: keeps a robot at a distance from an object that moves."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from rclpy.lifecycle import LifecycleState, TransitionCallbackReturn
from rclpy.time import Time
from tf2_ros import Buffer, TransformException, TransformListener

from daidalos.common.parameters import Parameters, group, parameter
from daidalos.navigation.docking.approach import ApproachParameters
from daidalos.navigation.errors import FailedToControl, FailedToDetectObject, NavigationError
from daidalos.navigation.following import FilteredPose, is_reached, pose_at_distance
from daidalos.nodes.action_results import TransformFailed, set_error
from daidalos.nodes.conversions import pose2_of, pose2_of_transform, pose_stamped
from daidalos.nodes.cycles import Cycle
from daidalos.nodes.managed import ManagedNode
from daidalos.nodes.opennav_docking._drive import Drive
from daidalos.nodes.parameters import declare, declare_without_effect
from daidalos.nodes.warming import warm_up_in_background
from daidalos.samples.fields import duration_message, seconds

_BEYOND = 0.25
"""How much nearer [m] to the object the control law aims: it is singular at its target."""

_WITHOUT_EFFECT = {
    "transform_tolerance": "the age of the robot's transform is limited by data_timeout",
    "odom_duration": "the turn rate is that of the latest odometry",
    "action_server_result_timeout": "results are kept as long as the server runs",
    "bond_heartbeat_period": "there are no bonds; the lifecycle manager asks for states",
}
"""Parameters of some of Nav2's releases that do nothing here, with the reason."""


@dataclass(frozen=True)
class FollowingApproach(ApproachParameters):
    """Parameters below `controller`, by their Nav2 names."""

    use_collision_detection: bool = parameter(False, "Whether obstacles on the way stop the robot.", read_only=True)


@dataclass(frozen=True)
class FollowingServerParameters(Parameters):
    """Parameters of the node, by their Nav2 names; `data_timeout` is ours."""

    controller_frequency: float = parameter(50.0, "Cycles per second.", unit="Hz", above=0.0)
    detection_timeout: float = parameter(
        2.0, "Age of the object's pose from which on the robot stands.", unit="s", above=0.0
    )
    rotate_to_object_timeout: float = parameter(
        10.0, "How long the robot may turn to see it again.", unit="s", minimum=0.0
    )
    static_object_timeout: float = parameter(
        -1.0, "How long the robot stands before the object until the goal is reached; 0 or less for ever.", unit="s"
    )
    linear_tolerance: float = parameter(0.15, "Distance at which the robot stands.", unit="m", above=0.0)
    angular_tolerance: float = parameter(0.15, "Angle at which it stands.", unit="rad", above=0.0)
    max_retries: int = parameter(3, "How often the object may be lost or not be reached.", minimum=0)
    base_frame: str = parameter("base_link", "Frame of the robot's base.", not_empty=True, read_only=True)
    fixed_frame: str = parameter("odom", "Frame in which the robot moves smoothly.", not_empty=True, read_only=True)
    desired_distance: float = parameter(1.0, "Distance from the object.", unit="m", minimum=0.0)
    skip_orientation: bool = parameter(True, "Whether the object is followed wherever it looks.")
    search_by_rotating: bool = parameter(False, "Whether the robot turns to see it again.")
    search_angle: float = parameter(0.5 * math.pi, "How far, to each side.", unit="rad", minimum=0.0)
    odom_topic: str = parameter("odom", "Topic of the odometry.", not_empty=True, read_only=True)
    filter_coef: float = parameter(
        0.1, "Share of the newest pose in the filtered one; 0: no filter.", minimum=0.0, maximum=1.0
    )
    enable_stamped_cmd_vel: bool = parameter(False, "Whether cmd_vel is stamped.", read_only=True)
    data_timeout: float = parameter(
        1.0, "Age of the robot's transform or the costmap from which on it stops.", unit="s", above=0.0
    )
    controller: FollowingApproach = group(FollowingApproach)


@dataclass
class _Pursuit:
    """Object that is followed: by its frame or its latest message, and its filtered pose."""

    frame: str
    filtered: FilteredPose
    begun: float
    message: Any = None
    retries: int = 0
    standing_since: float | None = None


class FollowingServer(ManagedNode):
    """Server of ``follow_object`` that publishes ``cmd_vel``."""

    def __init__(self, node_name: str = "following_server", **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        self._settings = declare(self, FollowingServerParameters, reconfigure=self._reconfigure)
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)
        self._compiled = warm_up_in_background("daidalos.navigation", self.get_logger(), ())
        self._drive: Drive | None = None
        self._current: Any = None

    def _reconfigure(self, parameters: FollowingServerParameters) -> None:
        """Use other parameters from the next cycle on."""
        self._settings = parameters
        if self._drive is not None:
            self._drive.parameters = parameters.controller

    def configure(self) -> None:
        """Serve."""
        from geometry_msgs.msg import PoseStamped
        from rosidl_runtime_py.utilities import get_action

        declare_without_effect(self, _WITHOUT_EFFECT)
        self._action: Any = get_action("nav2_msgs/action/FollowObject")
        self._drive = Drive(self, self._buffer, self._settings, self._settings.controller)
        self._pose = self.create_publisher(PoseStamped, "filtered_dynamic_pose", 1)
        self.serve_action(self._action, "follow_object", self._serve, self._refusal)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop the robot and abort the goal."""
        if self._current is not None and self._drive is not None:
            self._drive.stop()
        self._current = None
        return super().on_deactivate(state)

    @staticmethod
    def _refusal(request: Any) -> str:
        return "" if request.pose_topic or request.tracked_frame else "it has neither a pose_topic nor a tracked_frame"

    def _now(self) -> float:
        return 1e-9 * self.get_clock().now().nanoseconds

    async def _serve(self, goal_handle: Any) -> Any:
        """Carry out a goal, which replaces any other one, and stop the robot."""
        from geometry_msgs.msg import PoseStamped

        result, request, p = self._action.Result(), goal_handle.request, self._settings
        self._current = goal_handle
        await self._compiled
        assert self._drive is not None
        pursuit = _Pursuit(request.tracked_frame, FilteredPose(p.filter_coef, p.detection_timeout), self._now())
        listening = None
        if not request.tracked_frame:
            listening = self.create_subscription(
                PoseStamped, request.pose_topic, lambda one: setattr(pursuit, "message", one), 1
            )
        try:
            with Cycle(self, p.controller_frequency) as cycle:
                await self._follow(goal_handle, pursuit, self._drive, cycle)
        except NavigationError as error:
            self.get_logger().error(f"follow_object failed: {error}")
            set_error(result, error)
        finally:
            if listening is not None:
                self.destroy_subscription(listening)
            replaced = self._current is not goal_handle
            if not replaced:  # nor deactivated, which stops it
                self._drive.stop()
                self._current = None
        result.num_retries, result.total_elapsed_time = pursuit.retries, duration_message(self._now() - pursuit.begun)
        if not goal_handle.is_active:
            return result
        if goal_handle.is_cancel_requested:
            goal_handle.canceled()
        elif replaced or result.error_code:
            result.error_msg = result.error_msg or "replaced by another goal"
            goal_handle.abort(result)
        else:
            goal_handle.succeed()
        return result

    def _goes_on(self, goal_handle: Any) -> bool:
        return self._current is goal_handle and goal_handle.is_active and not goal_handle.is_cancel_requested

    async def _follow(self, goal_handle: Any, pursuit: _Pursuit, drive: Drive, cycle: Cycle) -> None:
        """Follow until the goal's time is over, the object stands, or all retries are used."""
        limit = seconds(goal_handle.request.max_duration)
        while self._goes_on(goal_handle):
            if 0.0 < limit < self._now() - pursuit.begun:
                return
            try:
                if self._step(goal_handle, pursuit, drive):
                    return
            except (FailedToDetectObject, FailedToControl) as problem:
                drive.stop()
                pursuit.retries += 1
                pursuit.standing_since = None
                if pursuit.retries > self._settings.max_retries:
                    raise
                self.get_logger().warning(f"following goes on after: {problem}")
                await self._search(goal_handle, pursuit, drive, cycle)
            await cycle.next()

    def _step(self, goal_handle: Any, pursuit: _Pursuit, drive: Drive) -> bool:
        """Make one cycle; return whether the object has stood for `static_object_timeout`."""
        p, feedback = self._settings, self._action.Feedback
        if not self._see(pursuit, drive):
            if pursuit.filtered.pose is None and self._now() - pursuit.begun <= p.detection_timeout:
                drive.stop()
                self._tell(goal_handle, pursuit, feedback.INITIAL_PERCEPTION)
                return False
            raise FailedToDetectObject(f"the object was not seen for {p.detection_timeout:g} s")
        robot, thing = drive.pose(), pursuit.filtered.pose
        assert thing is not None
        target = pose_at_distance(thing, robot, p.desired_distance, skip_orientation=p.skip_orientation)
        is_there = is_reached(
            target, robot, thing, p.linear_tolerance, p.angular_tolerance, skip_orientation=p.skip_orientation
        )
        if is_there:
            drive.stop()
            self._tell(goal_handle, pursuit, feedback.STOPPING)
            if pursuit.standing_since is None:
                pursuit.standing_since = self._now()
            return 0.0 < p.static_object_timeout < self._now() - pursuit.standing_since
        pursuit.standing_since = None
        self._tell(goal_handle, pursuit, feedback.CONTROLLING)
        if p.skip_orientation and math.hypot(*(thing - robot)[:2]) <= p.desired_distance:
            drive.turn_to(float(target[2]), 0.5 * p.angular_tolerance)  # it is near enough, but aside
            return False
        nearer = pose_at_distance(thing, robot, p.desired_distance - _BEYOND, skip_orientation=p.skip_orientation)
        drive.approach(nearer, backward=False, dock=thing)
        return False

    def _see(self, pursuit: _Pursuit, drive: Drive) -> bool:
        """Take the object's latest pose; return whether that is new enough."""
        p, now = self._settings, self._now()
        try:
            if pursuit.frame:
                found = self._buffer.lookup_transform(p.fixed_frame, pursuit.frame, Time())
                pursuit.filtered.take(pose2_of_transform(found.transform), seconds(found.header.stamp) or now)
            elif pursuit.message is not None:
                pose = drive.in_fixed_frame(pose2_of(pursuit.message.pose), pursuit.message.header.frame_id)
                if all(map(math.isfinite, pose)):
                    pursuit.filtered.take(pose, seconds(pursuit.message.header.stamp))
        except (TransformException, TransformFailed) as error:
            self.get_logger().warning(f"the object's pose is not used: {error}", throttle_duration_sec=1.0)
        if pursuit.filtered.pose is None or now - pursuit.filtered.stamp > p.detection_timeout:
            return False
        if self._pose.handle.has_subscribers:
            self._pose.publish(pose_stamped(pursuit.filtered.pose, p.fixed_frame, self.get_clock().now().to_msg()))
        return True

    async def _search(self, goal_handle: Any, pursuit: _Pursuit, drive: Drive, cycle: Cycle) -> None:
        """Wait for the object for `detection_timeout`, or turn to both sides where that is asked for."""
        p, begun = self._settings, self._now()
        yaw = float(drive.pose()[2])
        sides = [yaw + p.search_angle, yaw - p.search_angle] if p.search_by_rotating else []
        limit = p.rotate_to_object_timeout if sides else p.detection_timeout
        while self._goes_on(goal_handle) and not self._see(pursuit, drive) and self._now() - begun <= limit:
            self._tell(goal_handle, pursuit, self._action.Feedback.RETRY)
            if p.search_by_rotating and not sides:
                return
            if sides and drive.turn_to(sides[0], p.angular_tolerance):
                sides.pop(0)
            await cycle.next()

    def _tell(self, goal_handle: Any, pursuit: _Pursuit, state: int) -> None:
        goal_handle.publish_feedback(
            self._action.Feedback(
                state=state, following_time=duration_message(self._now() - pursuit.begun), num_retries=pursuit.retries
            )
        )
