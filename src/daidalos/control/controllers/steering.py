"""Steering controllers: bicycle, tricycle and Ackermann bases."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from daidalos.common.parameters import ParameterError, parameter
from daidalos.control.base_controller import BaseController
from daidalos.control.base_odometry import BaseOdometry, OdometryParameters
from daidalos.control.interfaces import Interfaces
from daidalos.control.steering import SteeredBase, speed_share
from daidalos.samples.controllers import SteeringSample
from daidalos.samples.sensors import Sample


@dataclass(frozen=True)
class SteeringParameters(OdometryParameters):
    """Parameters that all steering controllers share, as ROS names them in Humble, Jazzy and later."""

    reference_timeout: float = parameter(1.0, "Age at which a command is ignored; 0 for never.", unit="s", minimum=0.0)
    front_steering: bool = parameter(
        True, "Whether the front wheels steer and the rear ones are driven.", read_only=True
    )
    rear_wheels_names: tuple[str, ...] = parameter(
        (), "Joints of the rear wheels, right before left.", unique=True, read_only=True
    )
    front_wheels_names: tuple[str, ...] = parameter(
        (), "Joints of the front wheels, right before left.", unique=True, read_only=True
    )
    rear_wheels_state_names: tuple[str, ...] = parameter(
        (), "Joints that measure the rear wheels; empty for rear_wheels_names.", unique=True, read_only=True
    )
    front_wheels_state_names: tuple[str, ...] = parameter(
        (), "Joints that measure the front wheels; empty for front_wheels_names.", unique=True, read_only=True
    )
    traction_joints_names: tuple[str, ...] = parameter(
        (), "Joints of the driven wheels, right before left.", unique=True, read_only=True
    )
    steering_joints_names: tuple[str, ...] = parameter(
        (), "Joints that steer, right before left.", unique=True, read_only=True
    )
    traction_joints_state_names: tuple[str, ...] = parameter(
        (), "Joints that measure the driven wheels; empty for traction_joints_names.", unique=True, read_only=True
    )
    steering_joints_state_names: tuple[str, ...] = parameter(
        (), "Joints that measure the steering; empty for steering_joints_names.", unique=True, read_only=True
    )
    open_loop: bool = parameter(False, "Whether odometry comes from commands.", read_only=True)
    reduce_wheel_speed_until_steering_reached: bool = parameter(
        False, "Whether to drive slowly while the wheels are still turning.", read_only=True
    )
    velocity_rolling_window_size: int = parameter(
        10, "Number of cycles that the velocity of the odometry is averaged over.", above=0, read_only=True
    )
    position_feedback: bool = parameter(
        False, "Whether driven wheels measure angles instead of speeds.", read_only=True
    )
    use_stamped_vel: bool = parameter(
        True, "Whether commands are stamped (~/reference) or not (~/reference_unstamped).", read_only=True
    )
    wheelbase: float = parameter(0.0, "Distance between the axles.", unit="m", above=0.0, read_only=True)

    @property
    def base(self) -> SteeredBase:
        """Sizes of the base."""
        raise NotImplementedError

    @property
    def traction(self) -> tuple[str, ...]:
        """Joints of the driven wheels."""
        return self.traction_joints_names or (
            self.rear_wheels_names if self.front_steering else self.front_wheels_names
        )

    @property
    def steering(self) -> tuple[str, ...]:
        """Joints of the steered wheels."""
        return self.steering_joints_names or (
            self.front_wheels_names if self.front_steering else self.rear_wheels_names
        )

    @property
    def traction_states(self) -> tuple[str, ...]:
        """Joints whose states measure the driven wheels."""
        old = self.rear_wheels_state_names if self.front_steering else self.front_wheels_state_names
        return self.traction_joints_state_names or old or self.traction

    @property
    def steering_states(self) -> tuple[str, ...]:
        """Joints whose states measure the steered wheels."""
        old = self.front_wheels_state_names if self.front_steering else self.rear_wheels_state_names
        return self.steering_joints_state_names or old or self.steering

    def radius(self, front: float, rear: float, either: float) -> float:
        """Return the radius of the driven wheels; see the parameters of the bases."""
        return either or (rear if self.front_steering else front)

    def check(self) -> None:
        """Check the sizes, and the lengths of the lists."""
        base = self.base
        if base.wheel_radius <= 0.0:
            raise ParameterError("traction_wheels_radius", "or the radius of the driven wheels must be above 0")
        for what, given, count in (
            ("traction_joints_names", self.traction, base.traction_count),
            ("traction_joints_state_names", self.traction_states, base.traction_count),
            ("steering_joints_names", self.steering, base.steering_count),
            ("steering_joints_state_names", self.steering_states, base.steering_count),
        ):
            if len(given) != count:
                raise ParameterError(what, f"must have {count} elements, got {len(given)}")


@dataclass(frozen=True)
class BicycleParameters(SteeringParameters):
    """Parameters of a base with a driven wheel and a steered one."""

    front_wheel_radius: float = parameter(0.0, "Radius of the front wheel.", unit="m", minimum=0.0, read_only=True)
    rear_wheel_radius: float = parameter(0.0, "Radius of the rear wheel.", unit="m", minimum=0.0, read_only=True)
    traction_wheel_radius: float = parameter(0.0, "Radius of the driven wheel.", unit="m", minimum=0.0, read_only=True)

    @property
    def base(self) -> SteeredBase:
        """Sizes of the base."""
        radius = self.radius(self.front_wheel_radius, self.rear_wheel_radius, self.traction_wheel_radius)
        return SteeredBase(self.wheelbase, radius)


@dataclass(frozen=True)
class TricycleParameters(SteeringParameters):
    """Parameters of a base with two driven wheels and a steered one."""

    wheel_track: float = parameter(0.0, "Old name of traction_track_width.", unit="m", minimum=0.0, read_only=True)
    traction_track_width: float = parameter(
        0.0, "Distance between the driven wheels.", unit="m", minimum=0.0, read_only=True
    )
    front_wheels_radius: float = parameter(0.0, "Radius of the front wheels.", unit="m", minimum=0.0, read_only=True)
    rear_wheels_radius: float = parameter(0.0, "Radius of the rear wheels.", unit="m", minimum=0.0, read_only=True)
    traction_wheels_radius: float = parameter(
        0.0, "Radius of the driven wheels.", unit="m", minimum=0.0, read_only=True
    )

    @property
    def base(self) -> SteeredBase:
        """Sizes of the base."""
        radius = self.radius(self.front_wheels_radius, self.rear_wheels_radius, self.traction_wheels_radius)
        track = self.traction_track_width or self.wheel_track
        if track <= 0.0:
            raise ParameterError("traction_track_width", "must be above 0")
        return SteeredBase(self.wheelbase, radius, track)


@dataclass(frozen=True)
class AckermannParameters(SteeringParameters):
    """Parameters of a base with two driven wheels and two steered ones."""

    front_wheel_track: float = parameter(
        0.0, "Distance between the front wheels.", unit="m", minimum=0.0, read_only=True
    )
    rear_wheel_track: float = parameter(0.0, "Distance between the rear wheels.", unit="m", minimum=0.0, read_only=True)
    traction_track_width: float = parameter(
        0.0, "Distance between the driven wheels.", unit="m", minimum=0.0, read_only=True
    )
    steering_track_width: float = parameter(
        0.0,
        "Distance between the steered wheels; 0 for that of the driven ones.",
        unit="m",
        minimum=0.0,
        read_only=True,
    )
    front_wheels_radius: float = parameter(0.0, "Radius of the front wheels.", unit="m", minimum=0.0, read_only=True)
    rear_wheels_radius: float = parameter(0.0, "Radius of the rear wheels.", unit="m", minimum=0.0, read_only=True)
    traction_wheels_radius: float = parameter(
        0.0, "Radius of the driven wheels.", unit="m", minimum=0.0, read_only=True
    )

    @property
    def base(self) -> SteeredBase:
        """Sizes of the base."""
        radius = self.radius(self.front_wheels_radius, self.rear_wheels_radius, self.traction_wheels_radius)
        rear, front = self.rear_wheel_track, self.front_wheel_track
        traction = self.traction_track_width or (rear if self.front_steering else front)
        steering = self.steering_track_width or (front if self.front_steering else rear)
        if traction <= 0.0:
            raise ParameterError("traction_track_width", "must be above 0")
        return SteeredBase(self.wheelbase, radius, traction, steering if steering > 0.0 else traction)


class BicycleSteeringController(BaseController):
    """Controller of a base with one driven wheel and one steered wheel."""

    names = ("bicycle_steering_controller/BicycleSteeringController",)
    Parameters: ClassVar[type] = BicycleParameters
    chainable = True
    state_sample = SteeringSample
    parameters: SteeringParameters

    def configure(self) -> None:
        """Set the interface names."""
        p = self.parameters
        self._base = p.base
        feedback = "position" if p.position_feedback else "velocity"
        self.command_names = (
            *(f"{name}/velocity" for name in p.traction),
            *(f"{name}/position" for name in p.steering),
        )
        self.state_names = (
            *(f"{name}/{feedback}" for name in p.traction_states),
            *(f"{name}/position" for name in p.steering_states),
        )
        self.references = Interfaces(("linear/velocity", "angular/velocity"))
        self._count = self._base.traction_count
        self.odometry = BaseOdometry(
            p.odom_frame_id,
            p.base_frame_id,
            p.pose_covariance_diagonal,
            p.twist_covariance_diagonal,
            p.velocity_rolling_window_size,
        )
        self.input.timeout = p.reference_timeout

    def reconfigure(self, parameters: SteeringParameters) -> None:
        """Apply the changed timeout."""
        super().reconfigure(parameters)
        self.input.timeout = parameters.reference_timeout

    def activate(self, now_ns: int) -> None:
        """Reset the odometry and the references; the wheels keep their state."""
        super().activate(now_ns)
        self._turned: np.ndarray | None = None
        measured = self.states.read()[self._count :]
        self._angle = float(np.mean(np.nan_to_num(measured)))
        self._last = (0.0, 0.0)

    def deactivate(self) -> None:
        """Stop."""
        commands = self.commands.read()
        commands[: self._count] = 0.0
        self.commands.write(commands)

    def take_references(self, now_ns: int, period: float) -> None:
        """Apply the last velocity that has not timed out."""
        latest = self.input.latest(now_ns)
        if latest is not None:
            self.references.values[:] = latest[0], latest[2]

    def update(self, now_ns: int, period: float) -> Iterable[Sample]:
        """Update the odometry from the wheels, then command speeds and angles."""
        values = self.states.read()
        self._measure(values, period)
        speed, turn = (float(one) for one in np.nan_to_num(self.references.values))
        angle = self._base.steering_angle(speed, turn)
        self._angle = self._angle if angle is None else angle
        if self.parameters.reduce_wheel_speed_until_steering_reached:
            speed *= speed_share(abs(self._angle - float(np.mean(values[self._count :]))))
        self._last = (speed, speed * math.tan(self._angle) / self._base.wheelbase)
        speeds, angles = self._base.wheel_speeds(speed, self._angle), self._base.wheel_angles(self._angle)
        self.commands.write(np.concatenate((speeds, angles)))
        yield from self.odometry_samples(now_ns)
        if self.context.has_subscribers("~/controller_state"):
            measured, nothing = values[: self._count], np.zeros(0)
            positions, velocities = (measured, nothing) if self.parameters.position_feedback else (nothing, measured)
            yield SteeringSample(
                now_ns, "~/controller_state", "", positions, velocities, values[self._count :], speeds, angles
            )

    def _measure(self, values: np.ndarray, period: float) -> None:
        if self.parameters.open_loop:
            speed, turn = self._last
        else:
            wheels = values[: self._count]
            if self.parameters.position_feedback:
                before, self._turned = self._turned, wheels
                wheels = np.zeros_like(wheels) if before is None else (wheels - before) / period
            if np.isnan(wheels).any() or np.isnan(values).any():
                return
            speed, turn = self._base.motion(wheels, values[self._count :])
        self.odometry.move(speed * period, turn * period, period)


class TricycleSteeringController(BicycleSteeringController):
    """Controller of a base with two driven wheels and one steered wheel."""

    names = ("tricycle_steering_controller/TricycleSteeringController",)
    Parameters: ClassVar[type] = TricycleParameters


class AckermannSteeringController(BicycleSteeringController):
    """Controller of a base with two driven wheels and two steered wheels."""

    names = ("ackermann_steering_controller/AckermannSteeringController",)
    Parameters: ClassVar[type] = AckermannParameters
