"""Tricycle controller: one front wheel, driven and steered."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from daidalos.common.parameters import ParameterError, Parameters, group, parameter
from daidalos.common.pose3 import quaternion_from_yaw
from daidalos.control.base_odometry import BaseOdometry, OdometryParameters
from daidalos.control.contracts import Controller, Service, Subscription
from daidalos.control.speed_limiter import SpeedLimiter, SpeedLimits
from daidalos.control.steering import speed_share
from daidalos.control.velocity_input import VelocityInput
from daidalos.samples.commands import TwistCommand
from daidalos.samples.controllers import Answer, Asked, VelocityCommand
from daidalos.samples.sensors import OdometrySample, Sample, TransformSample

_NAN = math.nan


@dataclass(frozen=True)
class TractionLimits(Parameters):
    """Limits of the driven wheel's speed; NaN for none."""

    max_velocity: float = parameter(_NAN, "Largest speed of the wheel.", unit="rad/s")
    max_acceleration: float = parameter(_NAN, "Largest acceleration.", unit="rad/s^2")
    max_deceleration: float = parameter(_NAN, "Largest deceleration, positive.", unit="rad/s^2")
    max_jerk: float = parameter(_NAN, "Largest jerk.", unit="rad/s^3")


@dataclass(frozen=True)
class SteeringLimits(Parameters):
    """Limits of the steered wheel; NaN for none."""

    min_position: float = parameter(_NAN, "Least angle.", unit="rad")
    max_position: float = parameter(_NAN, "Largest angle.", unit="rad")
    max_velocity: float = parameter(_NAN, "Largest rate of the angle.", unit="rad/s")


@dataclass(frozen=True)
class TricycleDriveParameters(OdometryParameters):
    """Parameters of the tricycle drive, as ROS names them."""

    traction_joint_name: str = parameter("", "Joint of the driven wheel.", not_empty=True, read_only=True)
    steering_joint_name: str = parameter("", "Joint that steers it.", not_empty=True, read_only=True)
    wheelbase: float = parameter(0.0, "Distance from the wheel to the rear axle.", unit="m", above=0.0, read_only=True)
    wheel_radius: float = parameter(0.0, "Radius of the wheel.", unit="m", above=0.0, read_only=True)
    open_loop: bool = parameter(False, "Whether odometry comes from commands.", read_only=True)
    odom_only_twist: bool = parameter(False, "Whether the odometry's pose stays at zero.", read_only=True)
    cmd_vel_timeout: int = parameter(500, "Age at which a command is ignored; 0 for never.", unit="ms")
    velocity_rolling_window_size: int = parameter(
        10, "Number of cycles that the velocity of the odometry is averaged over.", above=0, read_only=True
    )
    use_stamped_vel: bool = parameter(True, "Whether ~/cmd_vel is stamped.", read_only=True)
    traction: TractionLimits = group(TractionLimits)
    steering: SteeringLimits = group(SteeringLimits)

    def check(self) -> None:
        """Check the limits of the angle."""
        if self.steering.min_position > self.steering.max_position:
            raise ParameterError("steering.min_position", "is above steering.max_position")


class TricycleController(Controller):
    """Controller of a base with a driven and steered front wheel, which can rotate in place."""

    names = ("tricycle_controller/TricycleController",)
    Parameters = TricycleDriveParameters
    parameters: TricycleDriveParameters

    def configure(self) -> None:
        """Set the interface names."""
        p = self.parameters
        self.command_names = (f"{p.traction_joint_name}/velocity", f"{p.steering_joint_name}/position")
        self.state_names = self.command_names
        self._odometry = BaseOdometry(
            p.odom_frame_id,
            p.base_frame_id,
            p.pose_covariance_diagonal,
            p.twist_covariance_diagonal,
            p.velocity_rolling_window_size,
        )
        limits = p.traction
        self._limiter = SpeedLimiter(
            SpeedLimits(
                max_velocity=limits.max_velocity,
                max_acceleration=limits.max_acceleration,
                max_deceleration=limits.max_deceleration,
                max_jerk=limits.max_jerk,
            ),
            "traction",
        )
        self._input = VelocityInput(self)
        self._input.timeout = p.cmd_vel_timeout * 1e-3

    def reconfigure(self, parameters: TricycleDriveParameters) -> None:
        """Apply the changed timeout."""
        super().reconfigure(parameters)
        self._input.timeout = parameters.cmd_vel_timeout * 1e-3

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """Odometry and its transform."""
        topics: dict[str, type[Sample]] = {"~/odom": OdometrySample}
        if self.parameters.enable_odom_tf:
            topics["/tf"] = TransformSample
        return topics

    @property
    def subscriptions(self) -> Mapping[str, Subscription]:
        """Commanded velocity."""
        if self.parameters.use_stamped_vel:
            return {"~/cmd_vel": Subscription(VelocityCommand, self._input.take)}
        return {"~/cmd_vel": Subscription(TwistCommand, self._input.take_plain)}

    @property
    def services(self) -> Mapping[str, Service]:
        """Reset of the odometry."""
        return {"~/reset_odometry": Service(Asked, self._reset)}

    def _reset(self, question: Asked) -> Answer:
        self._odometry.reset()
        return Answer(success=True)

    def activate(self, now_ns: int) -> None:
        """Reset the odometry; the wheel keeps its state."""
        self._input.reset()
        self._odometry.reset()
        self._angle = float(np.nan_to_num(self.states.read()[1]))
        self._speed = self._before = 0.0

    def deactivate(self) -> None:
        """Stop."""
        self.commands.write(np.array((0.0, self._angle)))

    def update(self, now_ns: int, period: float) -> Iterable[Sample]:
        """Update the odometry from the wheel, then command its speed and angle."""
        measured = self.states.read()
        wheel = (self._speed, self._angle) if self.parameters.open_loop else (float(measured[0]), float(measured[1]))
        self._measure(*wheel, period)
        latest = self._input.latest(now_ns)
        ahead, _, turn = latest or (0.0, 0.0, 0.0)
        speed, angle = self._wheel(ahead, turn)
        self._turn_to(angle, period)
        if not math.isnan(measured[1]):
            speed *= speed_share(abs(angle - float(measured[1])))
        allowed = self._limiter.limit(speed, self._speed, self._before, period)
        self._before, self._speed = self._speed, allowed
        self.commands.write(np.array((self._speed, self._angle)))
        odometry = self._odometry.sample(now_ns, "~/odom")
        if self.parameters.odom_only_twist:
            odometry = replace(odometry, position=np.zeros(3), orientation=np.array(quaternion_from_yaw(0.0)))
        yield odometry
        if self.parameters.enable_odom_tf:
            yield self._odometry.transform(now_ns)

    def _wheel(self, ahead: float, turn: float) -> tuple[float, float]:
        """Return the wheel's speed [rad/s] and angle [rad] for a velocity of the base; at rest the angle stays."""
        sideways = turn * self.parameters.wheelbase
        if ahead == 0.0 and turn == 0.0:
            return 0.0, self._angle
        speed = math.hypot(ahead, sideways) / self.parameters.wheel_radius
        angle = math.atan2(sideways, ahead)
        if abs(angle) > math.pi / 2:  # backwards
            return -speed, angle - math.copysign(math.pi, angle)
        return speed, angle

    def _turn_to(self, angle: float, period: float) -> None:
        limits = self.parameters.steering
        if not math.isnan(limits.max_position):
            angle = min(angle, limits.max_position)
        if not math.isnan(limits.min_position):
            angle = max(angle, limits.min_position)
        reach = math.inf if math.isnan(limits.max_velocity) else limits.max_velocity * period
        self._angle += min(max(angle - self._angle, -reach), reach)

    def _measure(self, speed: float, angle: float, period: float) -> None:
        if math.isnan(speed) or math.isnan(angle):
            return
        travel = speed * self.parameters.wheel_radius * period
        self._odometry.move(travel * math.cos(angle), travel * math.sin(angle) / self.parameters.wheelbase, period)
