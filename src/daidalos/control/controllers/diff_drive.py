"""Differential drive controller: wheel speeds from the base's commanded velocity, odometry from the wheels."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from daidalos.common.parameters import ParameterError, Parameters, group, parameter
from daidalos.common.rate_gate import RateGate
from daidalos.control.base_odometry import BaseOdometry, OdometryParameters, prefixed_frame
from daidalos.control.contracts import Controller, Subscription
from daidalos.control.interfaces import Interfaces
from daidalos.control.speed_limiter import SpeedLimiter, SpeedLimits
from daidalos.control.velocity_input import VelocityInput
from daidalos.samples.controllers import VelocitySample
from daidalos.samples.sensors import OdometrySample, Sample, TransformSample

_REFERENCES = ("linear/velocity", "angular/velocity")


@dataclass(frozen=True)
class LinearLimits(Parameters):
    """Limits along the base's x axis."""

    x: SpeedLimits = group(SpeedLimits)


@dataclass(frozen=True)
class AngularLimits(Parameters):
    """Limits about the base's z axis."""

    z: SpeedLimits = group(SpeedLimits)


@dataclass(frozen=True)
class DiffDriveParameters(OdometryParameters):
    """Parameters of the differential drive, as ROS names them; those of both Humble and Jazzy."""

    left_wheel_names: tuple[str, ...] = parameter(
        (), "Joints of the left wheels.", not_empty=True, unique=True, read_only=True
    )
    right_wheel_names: tuple[str, ...] = parameter(
        (), "Joints of the right wheels, as many as left ones.", not_empty=True, unique=True, read_only=True
    )
    wheel_separation: float = parameter(0.0, "Distance between left and right wheels.", unit="m", above=0.0)
    wheel_radius: float = parameter(0.0, "Radius of the wheels.", unit="m", above=0.0)
    wheel_separation_multiplier: float = parameter(1.0, "Correction factor of wheel_separation.", above=0.0)
    left_wheel_radius_multiplier: float = parameter(1.0, "Correction factor of the left wheels' radius.", above=0.0)
    right_wheel_radius_multiplier: float = parameter(1.0, "Correction factor of the right wheels' radius.", above=0.0)
    tf_frame_prefix_enable: bool = parameter(True, "Whether frames get a prefix.", read_only=True)
    tf_frame_prefix: str = parameter("", "Prefix of frames; empty for the namespace.", read_only=True)
    open_loop: bool = parameter(False, "Whether odometry comes from commands instead of wheels.", read_only=True)
    position_feedback: bool = parameter(True, "Whether wheels measure angles instead of speeds.", read_only=True)
    cmd_vel_timeout: float = parameter(0.5, "Age at which a command is ignored; 0 for never.", unit="s")
    publish_limited_velocity: bool = parameter(False, "Whether to publish ~/cmd_vel_out.", read_only=True)
    velocity_rolling_window_size: int = parameter(
        10, "Number of cycles that the velocity of the odometry is averaged over.", above=0, read_only=True
    )
    use_stamped_vel: bool = parameter(
        True, "Whether commands are stamped (~/cmd_vel) or not (~/cmd_vel_unstamped).", read_only=True
    )
    publish_rate: float = parameter(50.0, "How often the odometry is published.", unit="Hz", above=0.0, read_only=True)
    linear: LinearLimits = group(LinearLimits)
    angular: AngularLimits = group(AngularLimits)

    def check(self) -> None:
        """Check that both sides have the same number of wheels."""
        left, right = len(self.left_wheel_names), len(self.right_wheel_names)
        if left != right:
            raise ParameterError("right_wheel_names", f"has {right} elements, left_wheel_names has {left}")


class DiffDriveController(Controller):
    """Controller of a differential-drive base; all wheels of a side rotate alike."""

    names = ("diff_drive_controller/DiffDriveController",)
    Parameters = DiffDriveParameters
    chainable = True
    parameters: DiffDriveParameters

    def configure(self) -> None:
        """Set the names of the wheels' interfaces."""
        p, context = self.parameters, self.context
        wheels = (*p.left_wheel_names, *p.right_wheel_names)
        feedback = "position" if p.position_feedback else "velocity"
        self.command_names = tuple(f"{wheel}/velocity" for wheel in wheels)
        self.state_names = () if p.open_loop else tuple(f"{wheel}/{feedback}" for wheel in wheels)
        self.references = Interfaces(_REFERENCES)
        self._count = len(p.left_wheel_names)
        prefix = (context.namespace, p.tf_frame_prefix, p.tf_frame_prefix_enable)
        self._odometry = BaseOdometry(
            prefixed_frame(p.odom_frame_id, *prefix),
            prefixed_frame(p.base_frame_id, *prefix),
            p.pose_covariance_diagonal,
            p.twist_covariance_diagonal,
            p.velocity_rolling_window_size,
        )
        self._publishing = RateGate(p.publish_rate)
        self._input = VelocityInput(self)
        self._take_parameters()

    def reconfigure(self, parameters: DiffDriveParameters) -> None:
        """Apply changed limits, sizes and timeout."""
        super().reconfigure(parameters)
        self._take_parameters()

    def _take_parameters(self) -> None:
        p = self.parameters
        self._input.timeout = p.cmd_vel_timeout
        self._limiters = (SpeedLimiter(p.linear.x, "linear.x"), SpeedLimiter(p.angular.z, "angular.z"))
        self._separation = p.wheel_separation * p.wheel_separation_multiplier
        self._radii = (
            p.wheel_radius * p.left_wheel_radius_multiplier,
            p.wheel_radius * p.right_wheel_radius_multiplier,
        )

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """Odometry, its transform, and the limited velocity."""
        topics: dict[str, type[Sample]] = {"~/odom": OdometrySample}
        if self.parameters.enable_odom_tf:
            topics["/tf"] = TransformSample
        if self.parameters.publish_limited_velocity:
            topics["~/cmd_vel_out"] = VelocitySample
        return topics

    @property
    def subscriptions(self) -> Mapping[str, Subscription]:
        """Commanded velocity."""
        return self._input.subscription("~/cmd_vel", self.parameters.use_stamped_vel)

    def activate(self, now_ns: int) -> None:
        """Reset the odometry."""
        self._input.reset()
        self._odometry.reset()
        self.references.values[:] = np.nan
        self._last, self._before = np.zeros(2), np.zeros(2)
        self._angles: np.ndarray | None = None
        self._publishing.restart()

    def deactivate(self) -> None:
        """Stop."""
        self.commands.write(np.zeros(len(self.command_names)))

    def take_references(self, now_ns: int, period: float) -> None:
        """Apply the last velocity that has not timed out."""
        latest = self._input.latest(now_ns)
        if latest is not None:
            self.references.values[:] = latest[0], latest[2]

    def update(self, now_ns: int, period: float) -> Iterable[Sample]:
        """Update the odometry from the wheels, then command their speeds."""
        wanted = np.nan_to_num(self.references.values)
        self._measure(period)
        allowed = np.array(
            [
                limiter.limit(float(wanted[row]), float(self._last[row]), float(self._before[row]), period)
                for row, limiter in enumerate(self._limiters)
            ]
        )
        self._before, self._last = self._last, allowed
        self._drive(*allowed)
        if self._publishing.is_due(now_ns):
            yield self._odometry.sample(now_ns, "~/odom")
            if self.parameters.enable_odom_tf:
                yield self._odometry.transform(now_ns)
        if self.parameters.publish_limited_velocity:
            linear, angular = np.array((allowed[0], 0.0, 0.0)), np.array((0.0, 0.0, allowed[1]))
            yield VelocitySample(now_ns, "~/cmd_vel_out", self._odometry.base_frame, linear, angular)

    def _drive(self, speed: float, turn: float) -> None:
        rims = speed - turn * self._separation / 2, speed + turn * self._separation / 2
        speeds = [rim / radius for rim, radius in zip(rims, self._radii, strict=True)]
        self.commands.write(np.repeat(speeds, self._count))

    def _measure(self, period: float) -> None:
        """Update the odometry by the wheels' motion since the last cycle, or by their commands."""
        if self.parameters.open_loop:
            self._odometry.move(float(self._last[0]) * period, float(self._last[1]) * period, period)
            return
        values = self.states.read()
        if self.parameters.position_feedback:
            turned = np.zeros_like(values) if self._angles is None else values - self._angles
            self._angles = values
        else:
            turned = values * period
        if np.isnan(turned).any():
            return
        left = turned[: self._count].mean() * self._radii[0]
        right = turned[self._count :].mean() * self._radii[1]
        self._odometry.move((left + right) / 2, (right - left) / self._separation, period)
