"""The guiding program's side of EGM: a UDP port on which each message of a controller is answered with guidance."""

from __future__ import annotations

import math
import socket
import time
from contextlib import suppress
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.errors import UserError
from daidalos.common.pose3 import Pose
from daidalos.industry.egm.messages import (
    EgmCartesian,
    EgmHeader,
    EgmJoints,
    EgmPlanned,
    EgmPose,
    EgmQuaternion,
    EgmRobot,
    EgmSensor,
    EgmSpeedRef,
    Mci,
    MessageType,
    Motors,
)
from daidalos.industry.egm.wire import WireError, decode, encode

Array = NDArray[np.float64]

LOOPBACK = "127.0.0.1"
PORT = 6510
MAX_BYTES = 4096
_RESTART = 10
"""Messages in a row with numbers that came before, from which the controller has begun anew."""


class ControllerLost(UserError):
    """The controller has stopped sending."""


@dataclass(frozen=True)
class RobotState:
    """What a controller says of its robot.

    Attributes
    ----------
    number : int
        Of the message.
    joints : array of shape (n,)
        Angles, those of external axes last [rad].
    pose : Pose or None
        Of the tool, as the controller has it.
    is_guided : bool
        Whether motors are on and guidance moves the robot.
    """

    number: int
    joints: Array
    pose: Pose | None
    is_guided: bool


@dataclass
class EgmStatistics:
    """Counts of messages: taken, sent twice, late, missing by their numbers, and refused ones."""

    taken: int = 0
    repeated: int = 0
    late: int = 0
    missed: int = 0
    refused: int = 0


class EgmClient:
    """A UDP port on which one controller is guided.

    Parameters
    ----------
    address : str
        Own address that is listened on.
    port : int
        0 for any.
    controller : str, optional
        Address of the controller; without, the first sender is taken for it.

    Raises
    ------
    UserError
        Where the port cannot be opened.
    """

    def __init__(self, address: str = LOOPBACK, port: int = PORT, controller: str | None = None) -> None:
        self.statistics = EgmStatistics()
        self.last_refusal = ""
        self._controller = controller
        self._peer: tuple[str, int] | None = None
        self._latest: int | None = None
        self._old_in_a_row = 0
        self._sent = 0
        self._axes = 0
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            self._socket.bind((address, port))
        except (OSError, OverflowError) as error:
            self._socket.close()
            raise UserError(f"{address}:{port} cannot be listened on: {getattr(error, 'strerror', error)}") from None

    def __enter__(self) -> EgmClient:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Close the port."""
        self._socket.close()

    @property
    def port(self) -> int:
        """Port that is listened on."""
        return int(self._socket.getsockname()[1])

    def receive(self, timeout: float) -> RobotState | None:
        """Return the newest state that came, or comes within a time [s]; None where there is none."""
        deadline = time.monotonic() + timeout
        newest: RobotState | None = None
        while True:
            wait = 0.0 if newest is not None else max(deadline - time.monotonic(), 0.0)
            self._socket.settimeout(wait)
            try:
                data, sender = self._socket.recvfrom(MAX_BYTES + 1)
            except (BlockingIOError, TimeoutError):
                return newest
            except ConnectionResetError:  # what Windows says of guidance that nobody took
                continue
            state = self._state_of(data, sender)
            if state is not None:
                newest = state
            elif newest is None and time.monotonic() > deadline:
                return None

    def wait(self, timeout: float) -> RobotState:
        """Return the next state.

        Raises
        ------
        ControllerLost
            Where none came within the time [s].
        """
        state = self.receive(timeout)
        if state is None:
            why = f"; the last message was refused: {self.last_refusal}" if self.last_refusal else ""
            raise ControllerLost(f"no message of a controller came within {timeout:g} s{why}")
        return state

    def _state_of(self, data: bytes, sender: tuple[str, int]) -> RobotState | None:
        if self._controller is not None and sender[0] != self._controller:
            return self._refuse(f"it came from {sender[0]}")
        try:
            message = decode(EgmRobot, data)
        except WireError as error:
            return self._refuse(str(error))
        number = message.header.seqno if message.header is not None else None
        feedback = message.feedBack
        if number is None or feedback is None or feedback.joints is None:
            return self._refuse("it has no seqno or no joints")
        joints = np.radians([*feedback.joints.joints, *(feedback.externalJoints or EgmJoints()).joints])
        if not len(joints) or not np.isfinite(joints).all():
            return self._refuse("its joints are missing or not finite")
        if not self._is_next(number):
            return None
        self._controller, self._peer = sender[0], sender
        self._axes = len(feedback.joints.joints)
        self.statistics.taken += 1
        is_on = message.motorState is None or message.motorState.state == Motors.ON
        is_running = message.mciState is not None and message.mciState.state == Mci.RUNNING
        return RobotState(number, joints, _pose_of(feedback.cartesian), is_on and is_running)

    def _refuse(self, reason: str) -> RobotState | None:
        self.statistics.refused += 1
        self.last_refusal = reason
        return None

    def _is_next(self, number: int) -> bool:
        """Return whether a message is newer than the last one, or the controller has begun anew; count the others."""
        latest = self._latest
        if latest is not None and number <= latest:
            is_repeated = number == latest
            self.statistics.repeated += is_repeated
            self.statistics.late += not is_repeated
            self._old_in_a_row += 1
            if is_repeated or self._old_in_a_row < _RESTART:
                return False
        elif latest is not None:
            self.statistics.missed += number - latest - 1
        self._latest, self._old_in_a_row = number, 0
        return True

    def send_joints(self, joints: Array, speeds: Array | None = None) -> None:
        """Send angles [rad], those of external axes last, and the speeds at which they are to be passed [rad/s].

        Raises
        ------
        ValueError
            Where a value is not finite.
        """
        angles = _finite(joints)
        speed = None if speeds is None else _finite(speeds)
        own = self._axes or len(angles)
        reference = None
        if speed is not None:
            reference = EgmSpeedRef(_degrees(speed[:own]), None, _degrees(speed[own:]) if len(speed) > own else None)
        external = _degrees(angles[own:]) if len(angles) > own else None
        self._send(EgmPlanned(_degrees(angles[:own]), None, external), reference)

    def send_pose(self, pose: Pose) -> None:
        """Send a pose of the tool [m].

        Raises
        ------
        ValueError
            Where a value is not finite.
        """
        x, y, z, w = _finite(np.array(pose.orientation))
        place = EgmCartesian(*(1e3 * _finite(np.array(pose.position))).tolist())
        self._send(EgmPlanned(None, EgmPose(place, EgmQuaternion(float(w), float(x), float(y), float(z)))), None)

    def _send(self, planned: EgmPlanned, reference: EgmSpeedRef | None) -> None:
        if self._peer is None:
            return
        self._sent += 1
        header = EgmHeader(self._sent, round(1e3 * time.monotonic()) & 0xFFFFFFFF, MessageType.CORRECTION)
        with suppress(ConnectionRefusedError):  # the controller has gone; the messages that stay away say so
            self._socket.sendto(encode(EgmSensor(header, planned, reference)), self._peer)


def _finite(values: Array) -> Array:
    array = np.asarray(values, dtype=np.float64)
    if not np.isfinite(array).all():
        raise ValueError("guidance that is not finite is not sent")
    return array


def _degrees(angles: Array) -> EgmJoints:
    return EgmJoints(tuple(np.degrees(angles).tolist()))


def _pose_of(pose: EgmPose | None) -> Pose | None:
    if pose is None or pose.pos is None or pose.orient is None:
        return None
    numbers = (pose.pos.x, pose.pos.y, pose.pos.z, pose.orient.u1, pose.orient.u2, pose.orient.u3, pose.orient.u0)
    if not all(map(math.isfinite, numbers)):
        return None
    return Pose((1e-3 * numbers[0], 1e-3 * numbers[1], 1e-3 * numbers[2]), numbers[3:7])
