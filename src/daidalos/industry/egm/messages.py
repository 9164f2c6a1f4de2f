"""EGM's messages, with the names and numbers of their fields in ABB's package `abb.egm`.

Positions are in mm, angles in degrees. Quaternions begin with their real part.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

from daidalos.industry.egm.wire import wire


class MessageType(IntEnum):
    """Kinds of messages, as headers say them."""

    UNDEFINED = 0
    COMMAND = 1
    DATA = 2
    CORRECTION = 3
    PATH_CORRECTION = 4


class Motors(IntEnum):
    """States of the motors."""

    UNDEFINED = 0
    ON = 1
    OFF = 2


class Mci(IntEnum):
    """States of the motion control interface, through which EGM guides."""

    UNDEFINED = 0
    ERROR = 1
    STOPPED = 2
    RUNNING = 3


class Rapid(IntEnum):
    """States of the execution of programs."""

    UNDEFINED = 0
    STOPPED = 1
    RUNNING = 2


@dataclass(frozen=True)
class EgmHeader:
    """Number and time [ms] of a message, and its kind."""

    seqno: int | None = wire(1)
    tm: int | None = wire(2)
    mtype: int | None = wire(3)


@dataclass(frozen=True)
class EgmCartesian:
    """Position [mm]."""

    x: float = wire(1, is_required=True)
    y: float = wire(2, is_required=True)
    z: float = wire(3, is_required=True)


@dataclass(frozen=True)
class EgmQuaternion:
    """Orientation; u0 is the real part."""

    u0: float = wire(1, is_required=True)
    u1: float = wire(2, is_required=True)
    u2: float = wire(3, is_required=True)
    u3: float = wire(4, is_required=True)


@dataclass(frozen=True)
class EgmEuler:
    """Orientation by turns about fixed x, y and z, in this order [deg]."""

    x: float = wire(1, is_required=True)
    y: float = wire(2, is_required=True)
    z: float = wire(3, is_required=True)


@dataclass(frozen=True)
class EgmClock:
    """Time of the controller."""

    sec: int = wire(1, is_required=True)
    usec: int = wire(2, is_required=True)


@dataclass(frozen=True)
class EgmPose:
    """Pose, with its orientation in one of two forms."""

    pos: EgmCartesian | None = wire(1)
    orient: EgmQuaternion | None = wire(2)
    euler: EgmEuler | None = wire(3)


@dataclass(frozen=True)
class EgmJoints:
    """Angles, or their speeds [deg], [deg/s]."""

    joints: tuple[float, ...] = wire(1, default=())


@dataclass(frozen=True)
class EgmCartesianSpeed:
    """Speed of a position [mm/s] and of its turn [deg/s]."""

    value: tuple[float, ...] = wire(1, default=())


@dataclass(frozen=True)
class EgmPlanned:
    """Where the robot, and its external axes, are to be."""

    joints: EgmJoints | None = wire(1)
    cartesian: EgmPose | None = wire(2)
    externalJoints: EgmJoints | None = wire(3)
    time: EgmClock | None = wire(4)


@dataclass(frozen=True)
class EgmFeedBack:
    """Where the robot, and its external axes, are."""

    joints: EgmJoints | None = wire(1)
    cartesian: EgmPose | None = wire(2)
    externalJoints: EgmJoints | None = wire(3)
    time: EgmClock | None = wire(4)


@dataclass(frozen=True)
class EgmSpeedRef:
    """Speeds at which positions are to be passed."""

    joints: EgmJoints | None = wire(1)
    cartesians: EgmCartesianSpeed | None = wire(2)
    externalJoints: EgmJoints | None = wire(3)


@dataclass(frozen=True)
class EgmPathCorr:
    """Correction of a programmed path [mm], and its age [ms]."""

    pos: EgmCartesian = wire(1, is_required=True)
    age: int = wire(2, is_required=True)


@dataclass(frozen=True)
class EgmState:
    """State of the motors, of guided motion or of a program, as a number of `Motors`, `Mci` or `Rapid`."""

    state: int = wire(1, is_required=True)


@dataclass(frozen=True)
class EgmNumbers:
    """Test signals, or a measured force [N], [Nm]."""

    values: tuple[float, ...] = wire(1, default=())


@dataclass(frozen=True)
class EgmRobot:
    """What the controller sends."""

    header: EgmHeader | None = wire(1)
    feedBack: EgmFeedBack | None = wire(2)
    planned: EgmPlanned | None = wire(3)
    motorState: EgmState | None = wire(4)
    mciState: EgmState | None = wire(5)
    mciConvergenceMet: bool | None = wire(6)
    testSignals: EgmNumbers | None = wire(7)
    rapidExecState: EgmState | None = wire(8)
    measuredForce: EgmNumbers | None = wire(9)
    utilizationRate: float | None = wire(10)


@dataclass(frozen=True)
class EgmSensor:
    """What the guiding program sends."""

    header: EgmHeader | None = wire(1)
    planned: EgmPlanned | None = wire(2)
    speedRef: EgmSpeedRef | None = wire(3)


@dataclass(frozen=True)
class EgmSensorPathCorr:
    """What a program sends that corrects a path."""

    header: EgmHeader | None = wire(1)
    pathCorr: EgmPathCorr | None = wire(2)
