"""Mecanum drive controller: omnidirectional base with four mecanum wheels."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from daidalos.common.parameters import Parameters, group, parameter
from daidalos.control.base_controller import BaseController
from daidalos.control.base_odometry import BaseOdometry, OdometryParameters, prefixed_frame
from daidalos.control.interfaces import Interfaces
from daidalos.samples.controllers import MecanumSample
from daidalos.samples.sensors import Sample

_WHEELS = ("front_left", "rear_left", "rear_right", "front_right")
_SIDE = np.array([-1.0, 1.0, -1.0, 1.0])
"""How much of the speed to the left each wheel has."""
_TURN = np.array([-1.0, -1.0, 1.0, 1.0])
"""How much of the turn rate, times the base's size, each wheel has."""


@dataclass(frozen=True)
class BaseOffset(Parameters):
    """Pose of the base's frame in the frame of the wheels' centre."""

    x: float = parameter(0.0, "Offset ahead.", unit="m")
    y: float = parameter(0.0, "Offset to the left.", unit="m")
    theta: float = parameter(0.0, "Turn to the left.", unit="rad")


@dataclass(frozen=True)
class MecanumKinematics(Parameters):
    """Sizes of the base."""

    base_frame_offset: BaseOffset = group(BaseOffset)
    wheels_radius: float = parameter(0.0, "Radius of the wheels.", unit="m", above=0.0)
    sum_of_robot_center_projection_on_X_Y_axis: float = parameter(
        0.0, "Half the wheelbase plus half the track.", unit="m", above=0.0
    )


@dataclass(frozen=True)
class MecanumParameters(OdometryParameters):
    """Parameters of the mecanum drive, as ROS names them."""

    reference_timeout: float = parameter(0.0, "Age at which a command is ignored; 0 for never.", unit="s")
    front_left_wheel_command_joint_name: str = parameter(
        "", "Joint of the front left wheel.", not_empty=True, read_only=True
    )
    front_right_wheel_command_joint_name: str = parameter(
        "", "Joint of the front right wheel.", not_empty=True, read_only=True
    )
    rear_right_wheel_command_joint_name: str = parameter(
        "", "Joint of the rear right wheel.", not_empty=True, read_only=True
    )
    rear_left_wheel_command_joint_name: str = parameter(
        "", "Joint of the rear left wheel.", not_empty=True, read_only=True
    )
    front_left_wheel_state_joint_name: str = parameter(
        "", "Joint that measures the front left wheel; empty for the commanded one.", read_only=True
    )
    front_right_wheel_state_joint_name: str = parameter(
        "", "Joint that measures the front right wheel; empty for the commanded one.", read_only=True
    )
    rear_right_wheel_state_joint_name: str = parameter(
        "", "Joint that measures the rear right wheel; empty for the commanded one.", read_only=True
    )
    rear_left_wheel_state_joint_name: str = parameter(
        "", "Joint that measures the rear left wheel; empty for the commanded one.", read_only=True
    )
    kinematics: MecanumKinematics = group(MecanumKinematics)
    tf_frame_prefix_enable: bool = parameter(False, "Whether frames get a prefix.", read_only=True)
    tf_frame_prefix: str = parameter("", "Prefix of frames; empty for the namespace.", read_only=True)
    use_stamped_vel: bool = parameter(
        True, "Whether commands are stamped (~/reference) or not (~/reference_unstamped).", read_only=True
    )


class MecanumDriveController(BaseController):
    """Controller of a base with four mecanum wheels."""

    names = ("mecanum_drive_controller/MecanumDriveController",)
    Parameters = MecanumParameters
    chainable = True
    state_sample = MecanumSample
    parameters: MecanumParameters

    def configure(self) -> None:
        """Set the interface names."""
        p = self.parameters
        commands = [getattr(p, f"{wheel}_wheel_command_joint_name") for wheel in _WHEELS]
        states = [
            getattr(p, f"{wheel}_wheel_state_joint_name") or command
            for wheel, command in zip(_WHEELS, commands, strict=True)
        ]
        self.command_names = tuple(f"{name}/velocity" for name in commands)
        self.state_names = tuple(f"{name}/velocity" for name in states)
        self.references = Interfaces(("linear/x/velocity", "linear/y/velocity", "angular/z/velocity"))
        prefix = (self.context.namespace, p.tf_frame_prefix, p.tf_frame_prefix_enable)
        self.odometry = BaseOdometry(
            prefixed_frame(p.odom_frame_id, *prefix),
            prefixed_frame(p.base_frame_id, *prefix),
            p.pose_covariance_diagonal,
            p.twist_covariance_diagonal,
        )
        self._take_parameters()

    def reconfigure(self, parameters: MecanumParameters) -> None:
        """Apply changed sizes and timeout."""
        super().reconfigure(parameters)
        self._take_parameters()

    def _take_parameters(self) -> None:
        self.input.timeout = self.parameters.reference_timeout
        offset, kinematics = self.parameters.kinematics.base_frame_offset, self.parameters.kinematics
        cosine, sine = math.cos(offset.theta), math.sin(offset.theta)
        # From the base's velocity to that of the wheels' centre.
        self._to_centre = np.array([[cosine, -sine, offset.y], [sine, cosine, -offset.x], [0.0, 0.0, 1.0]])
        size_of_base = kinematics.sum_of_robot_center_projection_on_X_Y_axis
        self._to_wheels = np.column_stack((np.ones(4), _SIDE, _TURN * size_of_base)) / kinematics.wheels_radius

    def deactivate(self) -> None:
        """Stop."""
        self.commands.write(np.zeros(4))

    def take_references(self, now_ns: int, period: float) -> None:
        """Apply the last velocity that has not timed out."""
        latest = self.input.latest(now_ns)
        if latest is not None:
            self.references.values[:] = latest

    def update(self, now_ns: int, period: float) -> Iterable[Sample]:
        """Update the odometry from the wheels, then command their speeds."""
        wheels = self.states.read()
        if not np.isnan(wheels).any():
            centre = np.linalg.lstsq(self._to_wheels, wheels, rcond=None)[0]
            ahead, sideways, turn = np.linalg.solve(self._to_centre, centre) * period
            self.odometry.move(float(ahead), float(turn), period, float(sideways))
        wanted = np.nan_to_num(self.references.values)
        self.commands.write(self._to_wheels @ self._to_centre @ wanted)
        yield from self.odometry_samples(now_ns)
        if self.context.has_subscribers("~/controller_state"):
            yield MecanumSample(now_ns, "~/controller_state", self.odometry.base_frame, wheels, wanted)
