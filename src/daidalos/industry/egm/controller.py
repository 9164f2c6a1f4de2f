"""The controller's side of EGM, simulated: cycles of 4 ms, guided joints or poses, limits, and stops.

The robot follows what it is told by the speeds of its axes. Guidance that is not finite, old, or sent twice does not
count; a position that the robot must not or cannot take, and guidance that stays away, stop it, as on a controller.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from daidalos.common.pose3 import Pose, quaternion_from_rpy
from daidalos.industry.egm.bodies import AXES, body_of
from daidalos.industry.egm.messages import (
    EgmCartesian,
    EgmClock,
    EgmFeedBack,
    EgmHeader,
    EgmJoints,
    EgmPlanned,
    EgmPose,
    EgmQuaternion,
    EgmRobot,
    EgmSensor,
    EgmState,
    Mci,
    MessageType,
    Motors,
    Rapid,
)
from daidalos.industry.egm.wire import WireError, decode, encode
from daidalos.industry.motion.faults import MotionFault
from daidalos.industry.robots import Arm
from daidalos.industry.robots.redundant import RedundantArm

Array = NDArray[np.float64]

CYCLE = 0.004
"""Time between two messages [s]."""

_CONVERGED = math.radians(0.05)
_QUATERNION_TOLERANCE = 0.01


@dataclass(frozen=True)
class EgmSettings:
    """Settings that EGMSetupUC, EGMActJoint and EGMActPose have.

    Attributes
    ----------
    mode : str
        What is guided: ``joint`` or ``pose``.
    communication_timeout : float
        Time without guidance after which the robot stops [s].
    waits : bool
        Whether it waits for the first guidance as long as it takes; otherwise that has to come within the timeout.
    max_speed_deviation : float
        Greatest speed of an axis [deg/s]; those of the arm hold besides.
    """

    mode: Literal["joint", "pose"] = "joint"
    communication_timeout: float = 1.0
    waits: bool = False
    max_speed_deviation: float = 1000.0


class GuidedController:
    """A controller whose robot is guided.

    Parameters
    ----------
    arm : Arm or RedundantArm
        Its robot.
    joints : array of shape (n,), optional
        Angles at the beginning, in the controller's order [rad]; without them those with which the arm begins.
    settings : EgmSettings

    Attributes
    ----------
    joints : array of shape (n,)
        Present angles, in the controller's order [rad].
    stopped : str
        Why the robot has stopped; empty while it is guided.
    refused : int
        Messages that did not count.
    last_refusal : str
        Why the last of them did not.
    """

    def __init__(
        self, arm: Arm | RedundantArm, joints: Array | None = None, settings: EgmSettings | None = None
    ) -> None:
        self._body = body_of(arm)
        self.settings = settings or EgmSettings()
        beginning = self._body.home if joints is None else np.asarray(joints, dtype=np.float64)
        self.joints: Array = beginning.copy()
        self.stopped = ""
        self.refused = 0
        self.last_refusal = ""
        self._goal: Array = beginning.copy()
        self._cycles = 0
        self._latest = -1
        self._latest_time = 0.0

    @property
    def time(self) -> float:
        """Time since the start [s]."""
        return self._cycles * CYCLE

    def message(self) -> bytes:
        """Return what the controller sends in this cycle."""
        clock = EgmClock(int(self.time), round(1e6 * self.time) % 1_000_000)
        state = Mci.RUNNING if not self.stopped else Mci.STOPPED
        return encode(
            EgmRobot(
                header=EgmHeader(self._cycles, round(1e3 * self.time) & 0xFFFFFFFF, MessageType.DATA),
                feedBack=EgmFeedBack(*self._position(self.joints), clock),
                planned=EgmPlanned(*self._position(self._goal), clock),
                motorState=EgmState(Motors.ON),
                mciState=EgmState(state),
                mciConvergenceMet=bool(np.abs(self._goal - self.joints).max() < _CONVERGED),
                rapidExecState=EgmState(Rapid.STOPPED if self.stopped else Rapid.RUNNING),
                utilizationRate=0.0,
            )
        )

    def _position(self, joints: Array) -> tuple[EgmJoints, EgmPose, EgmJoints]:
        pose = Pose.from_matrix(self._body.pose(joints))
        x, y, z, w = pose.orientation
        place = EgmCartesian(*(1e3 * one for one in pose.position))
        degrees = np.degrees(joints).tolist()
        own, external = EgmJoints(tuple(degrees[:AXES])), EgmJoints(tuple(degrees[AXES:]))
        return own, EgmPose(place, EgmQuaternion(w, x, y, z)), external

    def take(self, data: bytes) -> str:
        """Take guidance, and return why it does not count; empty where it does."""
        if self.stopped:
            return self._refuse(f"guided motion has ended: {self.stopped}")
        try:
            sensor = decode(EgmSensor, data)
        except WireError as error:
            return self._refuse(str(error))
        number = sensor.header.seqno if sensor.header is not None else None
        if number is None:
            return self._refuse("the header has no seqno")
        if number <= self._latest:
            return self._refuse(f"seqno is {number} after {self._latest}")
        reason, goal = self._goal_of(sensor)
        if reason:
            return self._refuse(reason)
        self._latest, self._latest_time = number, self.time
        if goal is not None:
            self._goal = goal
        return ""

    def _refuse(self, reason: str) -> str:
        self.refused += 1
        self.last_refusal = reason
        return reason

    def _goal_of(self, sensor: EgmSensor) -> tuple[str, Array | None]:
        """Return why guidance does not count, or the angles that it asks for; a goal out of reach stops the robot."""
        planned = sensor.planned
        if planned is None:
            return "", None
        if self.settings.mode == "joint":
            if planned.joints is None:
                return "joints are guided, but it has none", None
            external = planned.externalJoints or EgmJoints()
            goal = np.radians([*planned.joints.joints, *external.joints])
            if goal.shape != self.joints.shape:
                return f"{len(goal)} joints are given, but the robot has {len(self.joints)}", None
            if not np.isfinite(goal).all():
                return "the joints are not finite", None
        else:
            if planned.cartesian is None:
                return "poses are guided, but it has none", None
            pose = _matrix_of(planned.cartesian)
            if pose is None:
                return "the pose is incomplete or not finite", None
            try:
                goal = self._body.joints_at(pose, self._goal)
            except MotionFault as fault:
                self._stop(str(fault))
                return "", None
        if not ((goal >= self._body.limits[:, 0]) & (goal <= self._body.limits[:, 1])).all():
            self._stop("joint out of range")
            return "", None
        return "", goal

    def _stop(self, reason: str) -> None:
        self.stopped = reason
        self._goal = self.joints.copy()

    def step(self) -> None:
        """Move the robot for a cycle."""
        self._cycles += 1
        is_waiting = self.settings.waits and self._latest < 0
        silence = 0.0 if is_waiting else self.time - self._latest_time
        if not self.stopped and silence > self.settings.communication_timeout:
            self._stop(f"no guidance for {self.settings.communication_timeout:g} s")
        speeds = np.minimum(self._body.speeds, math.radians(self.settings.max_speed_deviation))
        self.joints = self.joints + np.clip(self._goal - self.joints, -speeds * CYCLE, speeds * CYCLE)


def _matrix_of(pose: EgmPose) -> Array | None:
    """Return a pose (4, 4) [m], or None where it has no position and orientation that are finite."""
    if pose.pos is None:
        return None
    position = tuple(1e-3 * one for one in (pose.pos.x, pose.pos.y, pose.pos.z))
    if pose.orient is not None:
        w, x, y, z = pose.orient.u0, pose.orient.u1, pose.orient.u2, pose.orient.u3
        length = math.hypot(w, x, y, z)
        if not abs(length - 1.0) <= _QUATERNION_TOLERANCE:
            return None
        orientation = (x / length, y / length, z / length, w / length)
    elif pose.euler is not None:
        turns = (pose.euler.x, pose.euler.y, pose.euler.z)
        if not all(map(math.isfinite, turns)):
            return None
        orientation = quaternion_from_rpy(*map(math.radians, turns))
    else:
        return None
    if not all(map(math.isfinite, position)):
        return None
    return Pose((position[0], position[1], position[2]), orientation).matrix
