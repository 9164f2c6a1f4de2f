"""Docking server: drives robots into docks and out of them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from rclpy.lifecycle import LifecycleState, TransitionCallbackReturn
from tf2_ros import Buffer, TransformListener

from daidalos.common.arrays import Array
from daidalos.common.errors import UserError
from daidalos.common.parameters import Parameters, group, parameter, per_name
from daidalos.common.pose2 import compose, wrap
from daidalos.common.suggestions import hint
from daidalos.navigation.contracts import NavigationContext
from daidalos.navigation.docking.approach import ApproachParameters
from daidalos.navigation.docking.contracts import DockType
from daidalos.navigation.docking.database import DockInstance, read_docks
from daidalos.navigation.errors import (
    DockingError,
    DockNotInDatabase,
    DockNotValid,
    FailedToCharge,
    FailedToControl,
    FailedToDetectDock,
    NavigationError,
)
from daidalos.navigation.extensions import DOCK_TYPES
from daidalos.nodes.action_results import set_error
from daidalos.nodes.conversions import pose2_of, pose_stamped
from daidalos.nodes.cycles import Cycle
from daidalos.nodes.managed import ManagedNode
from daidalos.nodes.navigation_extensions import ExtensionMaker
from daidalos.nodes.opennav_docking._dock_listener import DockListener
from daidalos.nodes.opennav_docking._drive import Drive
from daidalos.nodes.opennav_docking._staging import Navigator
from daidalos.nodes.parameters import declare, declare_without_effect
from daidalos.nodes.warming import warm_up_in_background
from daidalos.samples.fields import duration_message

_BEYOND = 0.25
"""How far [m] beyond the dock the control law aims: it is singular at its target, and contact comes before."""

_TURNED = np.array([0.0, 0.0, math.pi])
_WITHOUT_EFFECT = {
    "controller.transform_tolerance": "the age of the robot's transform is limited by data_timeout",
    "action_server_result_timeout": "results are kept as long as the server runs",
    "bond_heartbeat_period": "there are no bonds; the lifecycle manager asks for states",
    "service_introspection_mode": "service introspection is configured by each service's own parameters",
}
"""Parameters of some of Nav2's releases that do nothing here, with the reason."""


@dataclass(frozen=True)
class DockingServerParameters(Parameters):
    """Parameters of the node, by their Nav2 names; `data_timeout` is ours."""

    controller_frequency: float = parameter(50.0, "Cycles per second.", unit="Hz", above=0.0)
    initial_perception_timeout: float = parameter(
        5.0, "How long the dock is looked for from the staging pose.", unit="s", minimum=0.0
    )
    wait_charge_timeout: float = parameter(5.0, "How long the charger may take.", unit="s", minimum=0.0)
    dock_approach_timeout: float = parameter(30.0, "How long the approach may take.", unit="s", minimum=0.0)
    rotate_to_dock_timeout: float = parameter(10.0, "How long the turn before docking may take.", unit="s", minimum=0.0)
    undock_linear_tolerance: float = parameter(
        0.05, "Distance at which the staging pose is reached.", unit="m", above=0.0
    )
    undock_angular_tolerance: float = parameter(0.05, "Angle at which it is reached.", unit="rad", above=0.0)
    rotation_angular_tolerance: float = parameter(
        0.05, "Angle at which the turn before docking ends.", unit="rad", above=0.0
    )
    max_retries: int = parameter(3, "How often docking is tried again.", minimum=0)
    base_frame: str = parameter("base_link", "Frame of the robot's base.", not_empty=True, read_only=True)
    fixed_frame: str = parameter("odom", "Frame in which the robot moves smoothly.", not_empty=True, read_only=True)
    odom_topic: str = parameter("odom", "Topic of the odometry.", not_empty=True, read_only=True)
    dock_backwards: bool = parameter(
        False, "Whether all docks are docked at backward; the docks' dock_direction is newer."
    )
    dock_prestaging_tolerance: float = parameter(
        0.5, "Distance from the staging pose (in m and rad) within which the robot need not drive there.", minimum=0.0
    )
    navigator_bt_xml: str = parameter("", "Behaviour tree by which it drives there.", read_only=True)
    enable_stamped_cmd_vel: bool = parameter(False, "Whether cmd_vel is stamped.", read_only=True)
    data_timeout: float = parameter(
        1.0, "Age of the robot's transform or the costmap from which on it stops.", unit="s", above=0.0
    )
    dock_plugins: tuple[str, ...] = parameter(
        ("simple_charging_dock",), "Names of the types of docks.", not_empty=True, unique=True, read_only=True
    )
    dock_database: str = parameter("", "File with docks; it comes before 'docks'.", read_only=True)
    docks: tuple[str, ...] = parameter((), "Names of docks.", unique=True, read_only=True)
    instances: Mapping[str, DockInstance] = per_name(DockInstance, by="docks", at="")
    controller: ApproachParameters = group(ApproachParameters)


@dataclass
class _Docking:
    """Dock that the robot is driven to, its type, and its pose in the fixed frame."""

    name: str
    kind: DockType
    listener: DockListener
    pose: Array
    staging: Array
    retries: int = 0
    begun: float = 0.0


class DockingServer(ManagedNode):
    """Server of ``dock_robot`` and ``undock_robot`` that publishes ``cmd_vel``."""

    def __init__(self, node_name: str = "docking_server", **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        self._settings = declare(self, DockingServerParameters, reconfigure=self._reconfigure)
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)
        self._compiled = warm_up_in_background("daidalos.navigation", self.get_logger(), ())
        self._drive: Drive | None = None
        self._current: Any = None
        self._docked_at = ""

    def _reconfigure(self, parameters: DockingServerParameters) -> None:
        """Use other parameters from the next cycle on."""
        self._settings = parameters
        if self._drive is not None:
            self._drive.parameters = parameters.controller

    def configure(self) -> None:
        """Make the types of docks, load the docks, and serve."""
        from geometry_msgs.msg import PoseStamped
        from nav2_msgs.action import DockRobot, UndockRobot
        from nav2_msgs.srv import ReloadDockDatabase

        declare_without_effect(self, _WITHOUT_EFFECT)
        p = self._settings
        maker = ExtensionMaker(self, NavigationContext(global_frame=p.fixed_frame, base_frame=p.base_frame))
        kinds: dict[str, DockType] = {
            name: maker.make(DOCK_TYPES, name, "opennav_docking::SimpleChargingDock") for name in p.dock_plugins
        }
        self._kinds = {
            name: (kind, DockListener(self, kind, self._buffer, p.fixed_frame)) for name, kind in kinds.items()
        }
        self._docks = read_docks(p.dock_database) if p.dock_database else dict(p.instances)
        for name, dock in self._docks.items():
            self._kind(dock.type, f"the dock '{name}'")
        self._drive = Drive(self, self._buffer, p, p.controller)
        self._navigator = Navigator(self, p.navigator_bt_xml)
        self._poses = {
            name: self.create_publisher(PoseStamped, name, 1)
            for name in ("dock_pose", "filtered_dock_pose", "staging_pose")
        }
        self._docked_at = ""
        self.create_service(ReloadDockDatabase, f"{self.get_name()}/reload_database", self._reload)
        self.serve_action(DockRobot, "dock_robot", partial(self._serve, DockRobot, self._dock))
        self.serve_action(UndockRobot, "undock_robot", partial(self._serve, UndockRobot, self._undock))

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop the robot and abort the goal."""
        if self._current is not None and self._drive is not None:
            self._drive.stop()
        self._current = None
        return super().on_deactivate(state)

    # Docks.

    def _kind(self, name: str, what: str) -> tuple[DockType, DockListener]:
        if not name and len(self._kinds) == 1:
            return next(iter(self._kinds.values()))
        if name not in self._kinds:
            raise DockNotValid(f"{what} has the type '{name}', which is not among dock_plugins"
                               f"{hint(name, list(self._kinds))}")  # fmt: skip
        return self._kinds[name]

    def _reload(self, request: Any, response: Any) -> Any:
        """Use the docks of another file; the present ones stay where that fails or a robot is being docked."""
        response.success = False
        try:
            if self._current is not None:
                raise DockNotValid("a robot is being docked or undocked")
            docks = read_docks(request.filepath)
            for name, dock in docks.items():
                self._kind(dock.type, f"the dock '{name}'")
            self._docks = docks
            response.success = True
        except UserError as error:
            self.get_logger().error(f"the docks were not changed: {error}")
        return response

    def _requested(self, request: Any) -> _Docking:
        """Return the dock that a goal asks for."""
        if request.use_dock_id:
            if request.dock_id not in self._docks:
                raise DockNotInDatabase(f"there is no dock '{request.dock_id}'{hint(request.dock_id, self._docks)}")
            dock = self._docks[request.dock_id]
            name, kind, pose, frame = request.dock_id, dock.type, np.array(dock.pose), dock.frame
        else:
            name, kind = "at the given pose", request.dock_type
            pose, frame = pose2_of(request.dock_pose.pose), request.dock_pose.header.frame_id
        if not np.isfinite(pose).all():
            raise DockNotValid(f"the pose of the dock {name} is not finite")
        made, listener = self._kind(kind, f"the dock {name}")
        return _Docking(name, made, listener, *self._place(made, pose, frame))

    def _place(self, kind: DockType, pose: Array, frame: str) -> tuple[Array, Array]:
        """Return the pose of a dock and its staging pose in the fixed frame."""
        assert self._drive is not None
        return self._drive.in_fixed_frame(pose, frame), self._drive.in_fixed_frame(kind.staging_pose(pose), frame)

    def _is_backward(self, kind: DockType) -> bool:
        return self._settings.dock_backwards or kind.is_backward

    # Goals.

    async def _serve(self, action: Any, carry_out: Callable[[Any, Any, Drive, Cycle], Any], goal_handle: Any) -> Any:
        """Carry out a goal, which replaces any other one, and stop the robot."""
        result = action.Result(success=False)
        self._current = goal_handle
        await self._compiled
        assert self._drive is not None
        try:
            with Cycle(self, self._settings.controller_frequency) as cycle:
                await carry_out(goal_handle, result, self._drive, cycle)
        except NavigationError as error:
            self.get_logger().error(f"{self._name_of(action)} failed: {error}")
            set_error(result, error)
            result.success = False
        finally:
            if self._current is goal_handle or self._current is None:
                self._drive.stop()
        return self._concluded(goal_handle, result)

    def _concluded(self, goal_handle: Any, result: Any) -> Any:
        replaced = self._current is not goal_handle
        if not replaced:
            self._current = None
        if not goal_handle.is_active:
            return result
        if goal_handle.is_cancel_requested:
            goal_handle.canceled()
        elif replaced:
            result.error_code, result.error_msg = type(result).UNKNOWN, "replaced by another goal"
            goal_handle.abort(result)
        elif result.error_code:
            goal_handle.abort(result)
        else:
            goal_handle.succeed()
        return result

    @staticmethod
    def _name_of(action: Any) -> str:
        return "docking" if action.__name__ == "DockRobot" else "undocking"

    def _is_over(self, goal_handle: Any) -> bool:
        is_active = goal_handle.is_active and not goal_handle.is_cancel_requested
        return not is_active or self._current is not goal_handle

    @property
    def _now(self) -> float:
        return self.get_clock().now().nanoseconds * 1e-9

    def _tell(self, goal_handle: Any, state: str, docking: _Docking) -> None:
        from nav2_msgs.action import DockRobot

        feedback = DockRobot.Feedback(state=getattr(DockRobot.Feedback, state), num_retries=docking.retries)
        feedback.docking_time = duration_message(self._now - docking.begun)
        goal_handle.publish_feedback(feedback)

    def _show(self, topic: str, pose: Array) -> None:
        if self._poses[topic].handle.has_subscribers:
            stamp = self.get_clock().now().to_msg()
            self._poses[topic].publish(pose_stamped(pose, self._settings.fixed_frame, stamp))

    # Docking.

    async def _dock(self, goal_handle: Any, result: Any, drive: Drive, cycle: Cycle) -> None:
        """Drive to the staging pose and into the dock, with retries."""
        begun, request = self._now, goal_handle.request
        docking = self._requested(request)
        docking.begun = begun
        kind, robot = docking.kind, drive.pose()
        if kind.is_charger and (kind.is_docked(robot) or kind.is_charging(robot)):
            self.get_logger().info("the robot is docked already")
            result.success = True
            return
        await self._stage(goal_handle, docking, drive, cycle)
        if self._is_over(goal_handle):
            return
        kind.start(docking.pose)
        while not self._is_over(goal_handle):
            try:
                result.success = await self._try(goal_handle, docking, drive, cycle)
                break
            except DockingError as error:
                if docking.retries >= self._settings.max_retries:
                    raise
                docking.retries += 1
                self.get_logger().warning(f"docking is tried again: {error}")
            finally:
                result.num_retries = docking.retries
            await self._retreat(goal_handle, docking, drive, cycle)
        if result.success:
            self._docked_at = next(name for name, (one, _) in self._kinds.items() if one is kind)

    async def _stage(self, goal_handle: Any, docking: _Docking, drive: Drive, cycle: Cycle) -> None:
        """Navigate to the staging pose where the robot is not near it."""
        self._tell(goal_handle, "NAV_TO_STAGING_POSE", docking)
        self._show("staging_pose", docking.staging)
        offset = docking.staging - drive.pose()
        offset[2] = wrap(offset[2])
        request = goal_handle.request
        is_near = float(np.sqrt(offset @ offset)) < self._settings.dock_prestaging_tolerance
        if is_near or not request.navigate_to_staging_pose:
            return
        goal = pose_stamped(docking.staging, self._settings.fixed_frame, self.get_clock().now().to_msg())
        is_over = partial(self._is_over, goal_handle)
        await self._navigator.go_to(goal, request.max_staging_time, cycle, is_over)

    async def _try(self, goal_handle: Any, docking: _Docking, drive: Drive, cycle: Cycle) -> bool:
        """Look for the dock, drive into it and wait for the charger; return whether that was done."""
        await self._perceive(goal_handle, docking, drive, cycle)
        if docking.kind.rotates_to_dock:
            await self._turn(goal_handle, float(docking.pose[2]) + math.pi, drive, cycle)
        await self._approach(goal_handle, docking, drive, cycle)
        drive.stop()
        if docking.kind.is_charger:
            await self._wait_for_charge(goal_handle, docking, drive, cycle)
        return not self._is_over(goal_handle)

    async def _perceive(self, goal_handle: Any, docking: _Docking, drive: Drive, cycle: Cycle) -> None:
        self._tell(goal_handle, "INITIAL_PERCEPTION", docking)
        drive.stop()
        begun = self._now
        while not self._is_over(goal_handle):
            try:
                self._refine(docking)
                return
            except FailedToDetectDock:
                if self._now - begun > self._settings.initial_perception_timeout:
                    raise
            await cycle.next()

    def _refine(self, docking: _Docking) -> None:
        docking.listener.update()
        docking.pose = docking.kind.refined_pose(docking.pose, self._now)
        self._show("dock_pose", docking.pose)
        self._show("filtered_dock_pose", docking.pose)

    async def _turn(self, goal_handle: Any, yaw: float, drive: Drive, cycle: Cycle) -> None:
        begun = self._now
        while not self._is_over(goal_handle) and not drive.turn_to(yaw, self._settings.rotation_angular_tolerance):
            if self._now - begun > self._settings.rotate_to_dock_timeout:
                raise FailedToControl("the turn to the dock took too long")
            await cycle.next()

    async def _approach(self, goal_handle: Any, docking: _Docking, drive: Drive, cycle: Cycle) -> None:
        """Drive until the robot is docked."""
        kind, begun = docking.kind, self._now
        backward = self._is_backward(kind)
        while not self._is_over(goal_handle):
            self._tell(goal_handle, "CONTROLLING", docking)
            robot = drive.pose()
            if kind.is_docked(robot) or (kind.is_charger and kind.is_charging(robot)):
                return
            if not kind.rotates_to_dock:  # otherwise the dock is behind the robot, and not seen
                self._refine(docking)
            target = compose(docking.pose, (_BEYOND, 0.0, math.pi if backward else 0.0))
            drive.approach(target, backward=backward, dock=docking.pose)
            if self._now - begun > self._settings.dock_approach_timeout:
                raise FailedToControl("the dock was not reached in time")
            await cycle.next()

    async def _wait_for_charge(self, goal_handle: Any, docking: _Docking, drive: Drive, cycle: Cycle) -> None:
        begun = self._now
        while not self._is_over(goal_handle) and not docking.kind.is_charging(drive.pose()):
            self._tell(goal_handle, "WAIT_FOR_CHARGE", docking)
            if self._now - begun > self._settings.wait_charge_timeout:
                raise FailedToCharge("the dock does not charge")
            await cycle.next()

    async def _retreat(self, goal_handle: Any, docking: _Docking, drive: Drive, cycle: Cycle) -> None:
        """Drive back to the staging pose."""
        kind, staging, begun = docking.kind, docking.staging, self._now
        if kind.rotates_to_dock:
            staging = compose(staging, _TURNED)
        while not self._is_over(goal_handle):
            self._tell(goal_handle, "RETRY", docking)
            if self._leave_for(staging, drive, backward=not self._is_backward(kind), dock=docking.pose):
                return
            if self._now - begun > self._settings.dock_approach_timeout:
                raise FailedToControl("the staging pose was not reached in time")
            await cycle.next()

    def _leave_for(self, staging: Array, drive: Drive, *, backward: bool, dock: Array) -> bool:
        """Command one cycle to the staging pose; return whether it is reached."""
        p = self._settings
        if float(np.hypot(*(staging - drive.pose())[:2])) < p.undock_linear_tolerance:
            return drive.turn_to(float(staging[2]), p.undock_angular_tolerance)
        drive.approach(staging, backward=backward, dock=dock)
        return False

    # Undocking.

    async def _undock(self, goal_handle: Any, result: Any, drive: Drive, cycle: Cycle) -> None:
        """Drive out of the dock to its staging pose."""
        request, robot = goal_handle.request, drive.pose()
        kind, _ = self._kind(request.dock_type or self._docked_at, "the dock that the robot is to leave")
        if kind.is_charger and not (kind.is_docked(robot) or kind.is_charging(robot)):
            self.get_logger().info("the robot is in no dock")
            result.success = True
            return
        backward = self._is_backward(kind)
        dock = compose(robot, _TURNED) if backward else robot
        staging = kind.staging_pose(dock)
        if kind.rotates_to_dock:
            staging = compose(staging, _TURNED)
        kind.start(dock)
        self._show("staging_pose", staging)
        begun = self._now
        while not self._is_over(goal_handle):
            if self._now - begun > request.max_undocking_time:
                raise FailedToControl("undocking took too long")
            can_leave = not kind.is_charger or kind.disable_charging()
            if can_leave and self._leave_for(staging, drive, backward=not backward, dock=dock):
                break
            await cycle.next()
        if kind.rotates_to_dock:
            await self._turn(goal_handle, float(staging[2]) + math.pi, drive, cycle)
        if self._is_over(goal_handle):
            return
        if kind.is_charger and not kind.has_stopped_charging(drive.pose()):
            raise FailedToControl("the robot is still charging at the staging pose")
        self._docked_at = ""
        result.success = True
