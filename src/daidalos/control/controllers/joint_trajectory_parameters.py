"""Parameters of the joint trajectory controller."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

from daidalos.control.errors import ParameterError
from daidalos.control.parameters import at_least, not_empty, one_of, parameter, per_name, subset_of, unique
from daidalos.control.pid import Gains

_COMMANDS = (
    {"position"},
    {"position", "velocity"},
    {"position", "velocity", "acceleration"},
    {"velocity"},
    {"effort"},
)
_STATES = ({"position"}, {"position", "velocity"}, {"position", "velocity", "acceleration"})


@dataclass(frozen=True)
class JointGains(Gains):
    """Gains of one joint from its position and velocity errors; `Gains` explains the rest.

    Parameters
    ----------
    i_clamp : float
        Old form of both clamps of the integral; 0 for none.
    ff_velocity_scale : float
        How much of the wanted velocity goes into the command.
    angle_wraparound : bool
        Read for old files; continuous joints are known from the description.
    """

    i_clamp: float = parameter(0.0)
    ff_velocity_scale: float = parameter(0.0)
    angle_wraparound: bool = parameter(default=False)

    @property
    def clamped(self) -> Gains:
        """The gains of the loop alone."""
        if self.i_clamp == 0.0 or math.isfinite(self.i_clamp_max) or math.isfinite(self.i_clamp_min):
            return self
        return replace(self, i_clamp_max=abs(self.i_clamp), i_clamp_min=-abs(self.i_clamp))


@dataclass(frozen=True)
class Constraints:
    """When a goal counts as reached.

    Parameters
    ----------
    stopped_velocity_tolerance : float
        Largest velocity of each joint at the end.
    goal_time : float
        How much later than planned the goal may be reached [s]; 0 is without limit.
    """

    stopped_velocity_tolerance: float = parameter(0.01, at_least(0.0))
    goal_time: float = parameter(0.0, at_least(0.0))


@dataclass(frozen=True)
class JointConstraints:
    """Largest position errors of one joint on the way and at the end; 0 for none."""

    trajectory: float = parameter(0.0, at_least(0.0))
    goal: float = parameter(0.0, at_least(0.0))


@dataclass(frozen=True)
class SpeedScaling:
    """How much slower than planned trajectories run.

    Parameters
    ----------
    initial_scaling_factor : float
        1 is as planned, 0 stands still.
    state_interface : str
        Where the hardware tells its factor; empty takes that of the topic ``~/speed_scaling_input``.
    command_interface : str
        Where the hardware is told the factor; empty for none.
    """

    initial_scaling_factor: float = parameter(1.0, at_least(0.0))
    state_interface: str = parameter("", read_only=True)
    command_interface: str = parameter("", read_only=True)


@dataclass(frozen=True)
class JointTrajectoryParameters:
    """Parameters, as ROS names them.

    Parameters
    ----------
    joints, command_joints : tuple of str
        Joints that are followed, and those that are commanded where they differ.
    command_interfaces, state_interfaces : tuple of str
    allow_partial_joints_goal : bool
        Whether trajectories may leave joints out.
    interpolate_from_desired_state, open_loop_control : bool
        Begin a trajectory where the last one wants the joints, and not where they are; the second is the old name
        and takes no feedback either.
    allow_integration_in_goal_trajectories : bool
        Whether waypoints may give velocities alone.
    set_last_command_interface_value_as_state_on_activation : bool
        Hold at first what was commanded last.
    action_monitor_rate : float
        How often a goal gives feedback [Hz].
    interpolation_method : str
        ``splines``, or ``none`` to jump from waypoint to waypoint.
    allow_nonzero_velocity_at_trajectory_end : bool
    cmd_timeout : float
        How long after its end a trajectory from the topic is held before the joints stay where they are [s].
    speed_scaling : SpeedScaling
    gains : mapping
        By joint, for velocity or effort commands.
    constraints : Constraints
    joint_constraints : mapping
        By joint, below ``constraints`` as well.
    """

    joints: tuple[str, ...] = parameter((), not_empty, unique, read_only=True)
    command_joints: tuple[str, ...] = parameter((), unique, read_only=True)
    command_interfaces: tuple[str, ...] = parameter(
        (), not_empty, unique, subset_of("position", "velocity", "acceleration", "effort"), read_only=True
    )
    state_interfaces: tuple[str, ...] = parameter(
        (), not_empty, unique, subset_of("position", "velocity", "acceleration"), read_only=True
    )
    allow_partial_joints_goal: bool = parameter(default=False)
    interpolate_from_desired_state: bool = parameter(default=False)
    open_loop_control: bool = parameter(default=False, read_only=True)
    allow_integration_in_goal_trajectories: bool = parameter(default=False)
    set_last_command_interface_value_as_state_on_activation: bool = parameter(default=True)
    action_monitor_rate: float = parameter(20.0, at_least(0.1), read_only=True)
    interpolation_method: str = parameter("splines", one_of("splines", "none"), read_only=True)
    allow_nonzero_velocity_at_trajectory_end: bool = parameter(default=False)
    cmd_timeout: float = parameter(0.0, at_least(0.0))
    state_publish_rate: float = parameter(50.0)
    speed_scaling: SpeedScaling = field(default_factory=SpeedScaling)
    gains: dict[str, JointGains] = field(default_factory=dict, metadata=per_name(JointGains, by="joints"))
    constraints: Constraints = field(default_factory=Constraints)
    joint_constraints: dict[str, JointConstraints] = field(
        default_factory=dict, metadata=per_name(JointConstraints, by="joints", at="constraints")
    )

    def check(self) -> None:
        """Refuse combinations that can not be controlled."""
        if set(self.command_interfaces) not in _COMMANDS:
            raise ParameterError("command_interfaces", f"can not be {', '.join(self.command_interfaces)} together")
        if set(self.state_interfaces) not in _STATES:
            raise ParameterError("state_interfaces", "must have position, before acceleration also velocity")
        strange = [name for name in self.command_joints if name not in self.joints]
        if strange and len(self.command_joints) != len(self.joints):
            raise ParameterError("command_joints", f"has {strange[0]!r}, which is not in joints")
