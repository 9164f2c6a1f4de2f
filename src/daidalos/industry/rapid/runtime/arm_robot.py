"""An arm that carries out movements: its model, moved by `daidalos.industry.motion`."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from daidalos.common.pose3 import Pose as BasePose
from daidalos.industry.motion.branches import check_configuration, flange_poses, joints_at
from daidalos.industry.motion.corners import Zone
from daidalos.industry.motion.curves import SHORTEST, Circle, Curve, JointCurve, Line
from daidalos.industry.motion.faults import MotionFault
from daidalos.industry.motion.kinematics import confdata, forward
from daidalos.industry.motion.orientations import Array
from daidalos.industry.motion.pieces import Limits, sample_curve, sample_wrist_path
from daidalos.industry.motion.planner import Movement, PathRest, Planner
from daidalos.industry.rapid.runtime.errors import FatalError, RapidError
from daidalos.industry.rapid.runtime.external_axes import ExternalAxes, ExternalAxis
from daidalos.industry.rapid.runtime.poses import Pose, pose_inverse, pose_product
from daidalos.industry.rapid.runtime.robot import Event, Move, Robot, wobj_pose
from daidalos.industry.robots import Arm

MM = 1e-3
LOOK_AHEAD = 32
"""Movements that a program may be ahead of the arm."""

SENSOR_PERIOD = 1e-3
"""Seconds between two looks at signals that depend on where the tool is."""

WATCH_PERIOD = 0.01
"""Seconds between two looks at world zones."""

HOME = (0.0, 0.0, 0.0, 0.0, 30.0, 0.0)
"""Angles that an arm begins with [deg]."""

_RETURN_TOLERANCE = math.radians(0.1)
"""Distance of each axis from a kept path at which it is taken up [rad]."""


@dataclass(frozen=True)
class Sample:
    """What an arm did from one sampling to the next.

    Attributes
    ----------
    times : array of shape (n,)
        Times [s].
    joints, speeds, accelerations : arrays of shape (n, 6)
        Angles [rad] and their derivatives.
    positions : array of shape (n, 3)
        Tool's centre point in the base [m].
    labels : list of str
        ``file:line`` of the instruction that is carried out.
    """

    times: Array
    joints: Array
    speeds: Array
    accelerations: Array
    positions: Array
    labels: list[str]


class ArmRobot:
    """Robot with the kinematics and the limits of an arm.

    Parameters
    ----------
    arm
        The arm.
    joints
        Angles at the beginning (6,) [deg].
    sensors
        Functions of the tool's position in the base [mm] that set signals, by their names.
    set_signal
        Sets a signal.
    sampling
        Seconds between two samples that are kept; 0 for none.
    external
        External axes by their letters; movements of them begin and end with a stop.
    """

    def __init__(
        self,
        arm: Arm,
        joints: tuple[float, ...] = HOME,
        sensors: dict[str, Callable[[list[float]], float]] | None = None,
        set_signal: Callable[[str, float], None] | None = None,
        sampling: float = 0.0,
        external: Mapping[str, ExternalAxis] | None = None,
    ) -> None:
        self.arm = arm
        self._external = ExternalAxes(external or {})
        self.planner = Planner(arm, np.radians(joints))
        self._count = 0
        self.samples: list[Sample] = []
        self._sensors = sensors or {}
        self._set_signal = set_signal
        self._sampling = sampling
        self._next_sample = 0
        self._tool = np.eye(4)
        self._events: list[tuple[Movement, Event]] = []
        self._kept: list[tuple[PathRest, list[tuple[Movement, Event]]]] = []
        self._watchers: list[Callable[[], None]] = []

    # Movements

    @property
    def title(self) -> str:
        """Return the maker's name of the arm."""
        return self.arm.title

    @property
    def count(self) -> int:
        """Return how many movements were taken."""
        return self._count

    def order(self, move: Move) -> bool:
        """Take a movement."""
        extax = move.target[1] if move.instruction == "MoveAbsJ" else move.target[3]
        goal = self._external.goal(extax)
        moves_external = not self._external.is_there(goal)
        if moves_external and not self.planner.is_at_rest:
            return False
        try:
            movement = self._movement(move)
            if moves_external:
                movement = self._with_external(movement, goal, move)
            is_taken = self.planner.append(movement)
        except MotionFault as fault:
            raise FatalError(str(fault)) from None
        if is_taken:
            self._warn_of_external(extax, move.line)
            self._external.go(goal)
            self._count += 1
            self._tool = movement.tool
            self._events += [(movement, event) for event in move.events]
        return is_taken

    def _with_external(self, movement: Movement, goal: list[float], move: Move) -> Movement:
        """Return a movement that takes the time that external axes need, and ends with a stop."""
        seconds = self._external.seconds(goal, move.speed)
        if movement.curve.length < SHORTEST:
            raise FatalError("a movement of external axes alone does not run with an arm; move its tool too")
        rate = min(movement.limits.rate, movement.curve.length / seconds)
        return replace(movement, limits=replace(movement.limits, rate=rate), zone=None)

    def _warn_of_external(self, extax: list[Any], line: str) -> None:
        ignored = self._external.ignored(extax)
        text = f"{line}: {', '.join(ignored)}: the arm has no such external axis; --external declares one"
        if ignored and text not in self.planner.warnings:
            self.planner.warnings.append(text)

    def _movement(self, move: Move) -> Movement:
        if not move.tool[0] or move.wobj[0]:
            raise FatalError("a stationary tool, or a work object that the robot holds, does not run with an arm")
        tool, start = matrix_of(move.tool[1]), self.planner.end_joints
        zone = None
        if not move.zone[0]:
            zone = Zone(MM * move.zone[1], MM * move.zone[2], math.radians(move.zone[4]))
        curve = self._curve(move, tool, start)
        settings = move.settings
        limits = Limits(
            MM * move.speed[0],
            math.radians(move.speed[1]) if move.speed[1] > 0.0 else math.inf,
            math.inf,
            settings.acceleration,
            settings.ramp,
            settings.path_acceleration,
        )
        if move.duration is not None:
            if not move.duration > 0.0:
                raise FatalError(f"\\T takes more than 0 s, not {move.duration:g}")
            greatest = MM * settings.greatest_speed
            limits = Limits(greatest, math.inf, curve.length / move.duration, *_shares(limits))
        movement = Movement(curve, limits, zone, tool, move.line)
        if curve.length >= SHORTEST:
            self._sample(move, movement, start)
        return movement

    def _curve(self, move: Move, tool: Array, start: Array) -> Curve:
        if move.instruction == "MoveAbsJ":
            return JointCurve.between(self.arm, tool, start, np.radians(np.array(move.target[0], dtype=np.float64)))
        position, orientation = _placed(move.wobj, move.target)
        if move.instruction == "MoveJ":
            pose = flange_poses(position[None], orientation[None], tool)[0]
            wanted = _configuration(move.target) if move.settings.checks_joint else None
            return JointCurve.between(self.arm, tool, start, joints_at(self.arm, pose, wanted, start))
        now = BasePose.from_matrix(forward(self.arm, start) @ tool)
        first, turned = np.array(now.position), np.array(now.orientation)
        if move.via is None:
            return Line(first, position, turned, orientation)
        via, via_turned = _placed(move.wobj, move.via)
        return Circle.through((first, via, position), (turned, via_turned, orientation), move.settings.circle)

    def _sample(self, move: Move, movement: Movement, start: Array) -> None:
        """Find the angles of a movement, and check the configuration that it ends with."""
        curve = movement.curve
        checks = move.settings.checks_line and move.instruction in ("MoveL", "MoveC")
        wanted = _configuration(move.target) if checks else None
        if move.settings.turns_wrist and not isinstance(curve, JointCurve):
            ends = curve.poses(np.array([curve.length]))
            end = joints_at(self.arm, flange_poses(*ends, movement.tool)[0], wanted, start)
            movement.sampled = sample_wrist_path(self.arm, movement.tool, curve, start, end)
            movement.blends_joints = True
            return
        movement.sampled = sample_curve(self.arm, movement.tool, curve, start)
        if wanted is not None:
            check_configuration(self.arm, movement.sampled.joints[-1], wanted)

    # Time

    def room(self) -> float:
        """Return the time until fewer movements than the look-ahead are waiting."""
        return self.planner.until_waiting(LOOK_AHEAD // 2) if self.planner.waiting > LOOK_AHEAD else 0.0

    def lead(self) -> float:
        """Return the time until the latest movement's corner path, or its end where that is a stop."""
        return self.planner.lead()

    def remaining(self) -> float:
        """Return the time until the arm stands in the latest target."""
        return self.planner.remaining()

    def advance(self, seconds: float) -> None:
        """Advance time, and keep samples."""
        if self._sampling > 0.0:
            self._keep(self.planner.now + seconds)
        self.planner.advance(seconds)

    def _keep(self, end: float) -> None:
        after = math.floor(end / self._sampling + 1e-9) + 1
        if after <= self._next_sample:
            return
        times = np.arange(self._next_sample, after) * np.float64(self._sampling)
        self._next_sample = after
        joints, speeds, accelerations = self.planner.motion_at(times)
        positions = (forward(self.arm, joints) @ self._tool)[:, :3, 3]
        labels = self.planner.label_at(times)
        self.samples.append(Sample(times, joints, speeds, accelerations, positions, labels))

    def next_event(self) -> float | None:
        """Return the time until the next trigger, or look at sensors, while the arm moves."""
        times = [self._due(*one) - self.planner.now for one in self._events]
        if (self._sensors or self._watchers) and self.planner.braking() > 0.0:
            times.append(SENSOR_PERIOD if self._sensors else WATCH_PERIOD)
        finite = [max(one, 0.0) for one in times if math.isfinite(one)]
        return min(finite, default=None)

    def _due(self, movement: Movement, event: Event) -> float:
        if self.planner.is_stopped and self.planner.braking() == 0.0:
            return math.inf
        if event.is_from_start:
            place = min(movement.offset + MM * event.distance, movement.end)
        else:
            place = max(movement.end - MM * event.distance, movement.offset)
        due = self.planner.time_of(place)
        if math.isinf(due) and self.planner.is_at_rest:
            return self.planner.now
        return due - event.time_before

    def serve(self) -> None:
        """Set signals of sensors, and do what is due on the path."""
        if self._sensors and self._set_signal is not None:
            position = self._tool_pose()[0]
            for name, function in self._sensors.items():
                self._set_signal(name, function(position))
        for look in self._watchers:
            look()
        due = [one for one in self._events if self._due(*one) <= self.planner.now + 1e-9]
        self._events = [one for one in self._events if all(one is not other for other in due)]
        for _, event in due:
            event.action()

    def stop(self) -> float:
        """Stop on the path."""
        self.planner.stop()
        return self.planner.braking()

    def resume(self) -> None:
        """Go on along the path."""
        self.planner.resume()

    def stretch(self, seconds: float) -> None:
        """Make the movement that begins now take so long, where it would take less."""
        self.planner.stretch(seconds)

    def follow(self, leader: Robot) -> float:
        """Move in proportion to another arm; take as long as a robot without joints."""
        if isinstance(leader, ArmRobot):
            return self.planner.follow(leader.planner)
        self.stretch(leader.remaining())
        return 1.0

    def clear(self) -> None:
        """Forget the rest of the path."""
        self.planner.clear()
        self._events = []

    def store(self) -> None:
        """Keep the rest of the path, where the arm is stopped on it."""
        if self.planner.braking() > 0.0:
            raise FatalError("StorePath: the arm still moves; StopMove comes first")
        self._kept.append((self.planner.store(), self._events))
        self._events = []

    def restore(self) -> None:
        """Take up the rest of the path that was kept latest, where the arm stands on it."""
        if not self._kept:
            raise FatalError("there is no path to restore; StorePath comes first")
        rest, events = self._kept.pop()
        away = float(np.abs(rest.joints - self._joints()).max())
        if away > _RETURN_TOLERANCE:
            raise FatalError(f"RestoPath: the arm is {math.degrees(away):.2f} deg from where the path was left")
        self.planner.restore(rest)
        self._events = events

    def watch(self, look: Callable[[], None]) -> None:
        """Call a function every `WATCH_PERIOD` while the arm moves."""
        self._watchers.append(look)

    # Positions

    def target_of(self, joints: list[Any], tool: list[Any], wobj: list[Any]) -> list[Any]:
        """Return the robtarget of a jointtarget."""
        angles = np.radians(np.array(joints[0], dtype=np.float64))
        at = pose_product(pose_inverse(wobj_pose(wobj)), pose_product(_pose(forward(self.arm, angles)), tool[1]))
        return [at[0], at[1], [float(one) for one in confdata(self.arm, angles)], list(joints[1])]

    def joints_of(self, target: list[Any], tool: list[Any], wobj: list[Any]) -> list[Any]:
        """Return the jointtarget of a robtarget."""
        position, orientation = _placed(wobj, target)
        pose = flange_poses(position[None], orientation[None], matrix_of(tool[1]))[0]
        try:
            angles = joints_at(self.arm, pose, _configuration(target), self._joints())
        except MotionFault as fault:
            raise RapidError("ERR_ROBLIMIT", str(fault)) from None
        return [np.degrees(angles).tolist(), list(target[3])]

    def robtarget(self, tool: list[Any], wobj: list[Any]) -> list[Any]:
        """Return where a tool is in a work object, with the configuration."""
        joints = self._joints()
        flange = _pose(forward(self.arm, joints))
        at = pose_product(pose_inverse(wobj_pose(wobj)), pose_product(flange, tool[1]))
        return [at[0], at[1], [float(one) for one in confdata(self.arm, joints)], self._extax()]

    def jointtarget(self) -> list[Any]:
        """Return the angles."""
        return [np.degrees(self._joints()).tolist(), self._extax()]

    @property
    def tool(self) -> Array:
        """Return the pose (4, 4) of the latest movement's tool on the flange [m]."""
        return self._tool

    def _extax(self) -> list[float]:
        return self._external.values(self.planner.share())

    def _tool_pose(self) -> Pose:
        return _pose(forward(self.arm, self._joints()) @ self._tool)

    def _joints(self) -> Array:
        return np.asarray(self.planner.joints_at(np.array([self.planner.now]))[0])


def _shares(limits: Limits) -> tuple[float, float, float]:
    return limits.acceleration, limits.ramp, limits.tool_acceleration


def _placed(wobj: list[Any], target: list[Any]) -> tuple[Array, Array]:
    """Return position [m] and orientation (x, y, z, w) of a robtarget in the base."""
    position, (w, x, y, z) = pose_product(wobj_pose(wobj), [target[0], target[1]])
    if not all(map(math.isfinite, (*position, w, x, y, z))):
        raise FatalError("the target is not finite")
    return MM * np.array(position), np.array([x, y, z, w]) / math.hypot(w, x, y, z)


def _configuration(target: list[Any]) -> tuple[int, int, int, int]:
    cf1, cf4, cf6, cfx = (int(one) for one in target[2])
    return cf1, cf4, cf6, cfx


def matrix_of(pose: Pose) -> Array:
    """Return a pose in mm as a matrix (4, 4) in metres."""
    (x, y, z), (qw, qx, qy, qz) = pose
    norm = math.hypot(qw, qx, qy, qz)
    if not norm > 0.0:
        raise FatalError("the tool's orientation is [0,0,0,0]")
    return BasePose((MM * x, MM * y, MM * z), (qx / norm, qy / norm, qz / norm, qw / norm)).matrix


def _pose(matrix: Array) -> Pose:
    pose = BasePose.from_matrix(matrix)
    x, y, z, w = (one if pose.orientation[3] >= 0.0 else -one for one in pose.orientation)
    return [[one / MM for one in pose.position], [w, x, y, z]]
