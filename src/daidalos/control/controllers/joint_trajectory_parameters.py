"""Parameters of the joint trajectory controller."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from daidalos.common.parameters import ParameterError, Parameters, group, parameter, per_name
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
    """Gains of one joint from its position and velocity errors."""

    i_clamp: float = parameter(0.0, "Old form of both clamps of the integral; 0 for none.")
    ff_velocity_scale: float = parameter(0.0, "Factor of the reference velocity in the command.")
    angle_wraparound: bool = parameter(
        False, "Whether the joint turns without end, as continuous joints of the robot's description do anyway."
    )

    @property
    def clamped(self) -> Gains:
        """Gains of the PID loop alone."""
        if self.i_clamp == 0.0 or math.isfinite(self.i_clamp_max) or math.isfinite(self.i_clamp_min):
            return self
        return replace(self, i_clamp_max=abs(self.i_clamp), i_clamp_min=-abs(self.i_clamp))


@dataclass(frozen=True)
class Constraints(Parameters):
    """Tolerances of goals."""

    stopped_velocity_tolerance: float = parameter(
        0.01, "Largest velocity of each joint at the end; 0 for any.", unit="rad/s or m/s", minimum=0.0
    )
    goal_time: float = parameter(
        0.0, "How much later than planned the goal may be reached; 0 for no limit.", unit="s", minimum=0.0
    )


@dataclass(frozen=True)
class JointConstraints(Parameters):
    """Maximum position errors of one joint."""

    trajectory: float = parameter(0.0, "Largest position error on the way; 0 for any.", unit="rad or m", minimum=0.0)
    goal: float = parameter(0.0, "Largest position error at the end; 0 for any.", unit="rad or m", minimum=0.0)


@dataclass(frozen=True)
class SpeedScaling(Parameters):
    """Speed scaling of trajectories."""

    initial_scaling_factor: float = parameter(
        1.0, "Speed of trajectories at first: 1 is as planned, 0 stands still.", minimum=0.0
    )
    state_interface: str = parameter(
        "", "State interface with the factor; empty to take it from the topic ~/speed_scaling_input.", read_only=True
    )
    command_interface: str = parameter(
        "", "Command interface that the factor is written to; empty for none.", read_only=True
    )


@dataclass(frozen=True)
class JointTrajectoryParameters(Parameters):
    """Parameters of the joint trajectory controller, as ROS names them."""

    joints: tuple[str, ...] = parameter(
        (), "Joints that follow trajectories.", not_empty=True, unique=True, read_only=True
    )
    command_joints: tuple[str, ...] = parameter(
        (), "Joints that are commanded; empty for those in joints.", unique=True, read_only=True
    )
    command_interfaces: tuple[str, ...] = parameter(
        (), "Interfaces that are commanded.", choices=("position", "velocity", "acceleration", "effort"),
        not_empty=True, unique=True, read_only=True,
    )  # fmt: skip
    state_interfaces: tuple[str, ...] = parameter(
        (), "Interfaces that are measured.", choices=("position", "velocity", "acceleration"),
        not_empty=True, unique=True, read_only=True,
    )  # fmt: skip
    allow_partial_joints_goal: bool = parameter(False, "Whether trajectories may leave joints out.")
    interpolate_from_desired_state: bool = parameter(
        False, "Whether a trajectory starts where the last one wants the joints, instead of where they are."
    )
    open_loop_control: bool = parameter(
        False, "Old name of interpolate_from_desired_state, which takes no feedback either.", read_only=True
    )
    allow_integration_in_goal_trajectories: bool = parameter(
        False, "Whether waypoints may give velocities or accelerations alone."
    )
    set_last_command_interface_value_as_state_on_activation: bool = parameter(
        True, "Whether to hold at first what was commanded last."
    )
    action_monitor_rate: float = parameter(
        20.0, "How often a goal gives feedback.", unit="Hz", minimum=0.1, read_only=True
    )
    interpolation_method: str = parameter(
        "splines", "How to move between waypoints; none jumps.", choices=("splines", "none"), read_only=True
    )
    allow_nonzero_velocity_at_trajectory_end: bool = parameter(False, "Whether the last waypoint may have a velocity.")
    cmd_timeout: float = parameter(
        0.0, "How long after its end a trajectory from the topic is held before the joints stay where they are; "
        "0 for ever.", unit="s", minimum=0.0,
    )  # fmt: skip
    speed_scaling: SpeedScaling = group(SpeedScaling)
    gains: dict[str, JointGains] = per_name(JointGains, by="joints")
    constraints: Constraints = group(Constraints)
    joint_constraints: dict[str, JointConstraints] = per_name(JointConstraints, by="joints", at="constraints")

    def check(self) -> None:
        """Check the combination of interfaces."""
        if set(self.command_interfaces) not in _COMMANDS:
            raise ParameterError("command_interfaces", f"cannot be {', '.join(self.command_interfaces)} together")
        if set(self.state_interfaces) not in _STATES:
            raise ParameterError("state_interfaces", "must have position, before acceleration also velocity")
        unknown = [name for name in self.command_joints if name not in self.joints]
        if unknown and len(self.command_joints) != len(self.joints):
            raise ParameterError("command_joints", f"has {unknown[0]!r}, which is not in joints")
