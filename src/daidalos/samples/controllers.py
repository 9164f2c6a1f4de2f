"""Samples, commands and requests of controllers, beside those of `daidalos.samples.sensors` and `commands`.

Times are nanoseconds of the node's clock, units are SI, quaternions are x, y, z, w.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.samples.sensors import Sample


@dataclass(frozen=True, eq=False)
class DynamicJointSample(Sample):
    """All state interfaces by joint: value by interface name."""

    joints: Mapping[str, Mapping[str, float]]


@dataclass(frozen=True, eq=False)
class InterfaceGroupsSample(Sample):
    """State interfaces of groups, such as GPIOs: value by interface name."""

    groups: Mapping[str, Mapping[str, float]]


@dataclass(frozen=True, eq=False)
class InterfaceGroupsCommand:
    """Values of command interfaces of groups, such as GPIOs.

    Parameters
    ----------
    groups : tuple of n strings
    values : tuple of n pairs
        For each group the names of its interfaces, and their values.
    """

    groups: tuple[str, ...]
    values: tuple[tuple[tuple[str, ...], tuple[float, ...]], ...]


@dataclass(frozen=True, eq=False)
class TrajectoryPoint:
    """State of n joints at one instant; None where a derivative is not known.

    Parameters
    ----------
    time : float
        From the start [s].
    positions, velocities, accelerations, efforts : array (n,) or None
    """

    time: float
    positions: Array | None = None
    velocities: Array | None = None
    accelerations: Array | None = None
    efforts: Array | None = None


@dataclass(frozen=True, eq=False)
class TrajectoryCommand:
    """Joint positions over time.

    Parameters
    ----------
    joints : tuple of n strings
    points : tuple of TrajectoryPoint
    start_ns : int
        When it starts; 0 is now.
    """

    joints: tuple[str, ...]
    points: tuple[TrajectoryPoint, ...]
    start_ns: int = 0


@dataclass(frozen=True)
class JointTolerance:
    """Goal tolerances of one joint; 0 means the parameters' value, a negative value no tolerance."""

    position: float = 0.0
    velocity: float = 0.0
    acceleration: float = 0.0


@dataclass(frozen=True, eq=False)
class TrajectoryRequest:
    """Goal of ``follow_joint_trajectory``.

    Parameters
    ----------
    trajectory : TrajectoryCommand
    path, goal : mapping
        Tolerances by joint.
    goal_time : float
        How much later than planned it may end [s]; 0 leaves it to the parameters, less lifts the tolerance.
    """

    trajectory: TrajectoryCommand
    path: Mapping[str, JointTolerance] = field(default_factory=dict)
    goal: Mapping[str, JointTolerance] = field(default_factory=dict)
    goal_time: float = 0.0


@dataclass(frozen=True, eq=False)
class TrajectoryFeedback:
    """Progress of a trajectory; see `TrajectorySample`."""

    stamp_ns: int
    joints: tuple[str, ...]
    desired: TrajectoryPoint
    actual: TrajectoryPoint
    error: TrajectoryPoint


@dataclass(frozen=True)
class TrajectoryResult:
    """Result of a trajectory: the action's error code and a message."""

    SUCCESSFUL = 0
    INVALID_GOAL = -1
    INVALID_JOINTS = -2
    OLD_HEADER_TIMESTAMP = -3
    PATH_TOLERANCE_VIOLATED = -4
    GOAL_TOLERANCE_VIOLATED = -5

    code: int
    text: str = ""


@dataclass(frozen=True, eq=False)
class TrajectorySample(Sample):
    """State of a trajectory controller.

    Parameters
    ----------
    joints : tuple of n strings
    desired, actual, error, output : TrajectoryPoint
    speed : float
        Of the trajectory's time; 1 is as planned.
    """

    joints: tuple[str, ...]
    desired: TrajectoryPoint
    actual: TrajectoryPoint
    error: TrajectoryPoint
    output: TrajectoryPoint
    speed: float = 1.0


@dataclass(frozen=True)
class SpeedCommand:
    """Speed scaling of trajectories: 1 is as planned, 0 stops."""

    factor: float


@dataclass(frozen=True)
class TrajectoryStateRequest:
    """Request for the desired state of a trajectory at a time [ns]."""

    time_ns: int


@dataclass(frozen=True, eq=False)
class TrajectoryStateResponse:
    """State of a trajectory, or that it is not known."""

    known: bool
    joints: tuple[str, ...] = ()
    point: TrajectoryPoint = field(default_factory=lambda: TrajectoryPoint(0.0))


@dataclass(frozen=True, eq=False)
class VelocityCommand:
    """Commanded velocity of the base with a stamp, which is 0 where the sender gave none."""

    linear: Array = field(default_factory=lambda: np.zeros(3))
    angular: Array = field(default_factory=lambda: np.zeros(3))
    stamp_ns: int = 0


@dataclass(frozen=True, eq=False)
class VelocitySample(Sample):
    """Velocity after a controller's limits; linear, angular (3,) [m/s, rad/s]."""

    linear: Array
    angular: Array


@dataclass(frozen=True, eq=False)
class ValuesCommand:
    """Commanded values, one for each of a controller's interfaces."""

    values: Array


@dataclass(frozen=True, eq=False)
class DofCommand:
    """Commanded values of degrees of freedom, and of their derivatives where given."""

    names: tuple[str, ...]
    values: Array
    rates: Array


@dataclass(frozen=True)
class Switched:
    """Request to switch something on or off."""

    on: bool


@dataclass(frozen=True)
class Asked:
    """Request without content."""


@dataclass(frozen=True)
class Answer:
    """Success of a request, with a message."""

    success: bool
    text: str = ""


@dataclass(frozen=True)
class DofState:
    """State of one closed loop."""

    name: str
    reference: float
    feedback: float
    feedback_dot: float
    error: float
    error_dot: float
    time_step: float
    output: float


@dataclass(frozen=True, eq=False)
class DofSample(Sample):
    """States of closed loops."""

    dofs: tuple[DofState, ...]


@dataclass(frozen=True)
class GripperRequest:
    """Goal of a gripper: position [m, rad] and maximum effort [N, N m] (0: no limit)."""

    position: float
    max_effort: float = 0.0


@dataclass(frozen=True)
class ParallelGripperRequest(GripperRequest):
    """Goal of a parallel gripper, with a maximum speed [m/s, rad/s] (0: no limit) and an optional joint."""

    max_velocity: float = 0.0
    joint: str = ""


@dataclass(frozen=True)
class GripperState:
    """Feedback and result of a gripper's goal."""

    stamp_ns: int
    joint: str
    position: float
    velocity: float
    effort: float
    stalled: bool
    reached_goal: bool


@dataclass(frozen=True, eq=False)
class StampedWrenchCommand:
    """Commanded force [N] and torque [N m], each (3,), in a frame; empty for the sensor's."""

    force: Array
    torque: Array
    frame_id: str = ""


@dataclass(frozen=True, eq=False)
class VariedRangeSample(Sample):
    """Distance [m] with the sensor's properties; see ``sensor_msgs/msg/Range``."""

    radiation_type: int
    field_of_view: float
    min_range: float
    max_range: float
    range: float
    variance: float


@dataclass(frozen=True, eq=False)
class PoseSample(Sample):
    """Pose: position (3,) [m], orientation (4,)."""

    position: Array
    orientation: Array


@dataclass(frozen=True, eq=False)
class SteeringSample(Sample):
    """State of a steered base.

    Parameters
    ----------
    positions : array
        Of the traction wheels [rad]; empty where speeds are measured.
    velocities : array
        Of the traction wheels [rad/s]; empty where positions are measured.
    steering : array
        Angles of the steered wheels [rad].
    velocity_commands, steering_commands : array
        Told to the traction wheels [rad/s] and the steered ones [rad].
    """

    positions: Array
    velocities: Array
    steering: Array
    velocity_commands: Array
    steering_commands: Array


@dataclass(frozen=True, eq=False)
class MecanumSample(Sample):
    """State of a mecanum base.

    Parameters
    ----------
    wheels : array (4,)
        Speeds of the front left, rear left, rear right and front right wheel [rad/s].
    reference : array (3,)
        Wanted speed ahead, to the left and turn rate [m/s, m/s, rad/s].
    """

    wheels: Array
    reference: Array


@dataclass(frozen=True, eq=False)
class AdmittanceSample(Sample):
    """State of an admittance law; vectors are in the base's axes, linear parts first.

    Parameters
    ----------
    mass, damping, stiffness : array (6,)
    selected : array (6,) of bool
    control_orientation : array (4,)
        Of the control frame in the base.
    sensor_position, sensor_orientation : array (3,), array (4,)
        Of the force sensor in the base.
    offset, velocity, acceleration : array (6,)
        By which the tip yields.
    wrench : array (6,)
    joints : tuple of n strings
    joint_offset, joint_velocity : array (n,)
    """

    mass: Array
    damping: Array
    stiffness: Array
    selected: NDArray[np.bool_]
    control_orientation: Array
    sensor_frame: str
    sensor_position: Array
    sensor_orientation: Array
    offset: Array
    velocity: Array
    acceleration: Array
    wrench: Array
    joints: tuple[str, ...]
    joint_offset: Array
    joint_velocity: Array
