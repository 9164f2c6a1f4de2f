"""IMU: turn rates, specific force and orientation of a link."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.description.markup import Element
from daidalos.description.pose import Pose, Quaternion, multiply, rotation_matrix
from daidalos.simulation.noise import Noise, NoiseVector, read_noise
from daidalos.simulation.samples import ImuSample, Sample
from daidalos.simulation.sensors.base import Sensor

Array = NDArray[np.float64]


@dataclass
class Biases:
    """Errors of turn rate and acceleration (6,): those that stay, and those that wander."""

    constant: Array
    wandering: Array
    stamp_ns: int


class Imu(Sensor):
    """An inertial measurement unit in ROS's conventions (REP 145): at rest it measures +g upwards.

    Attributes
    ----------
    reference : tuple of 4 floats
        Orientation that is reported as none; a plugin may set it.
    """

    types = ("imu",)
    default_topic = "imu"
    memory: Biases

    def read(self, element: Element) -> None:
        """Read the noise of each axis, in the old form and the new."""
        settings = element.first("imu") or Element("imu")
        old = settings.first("noise")
        if old is not None:
            silent = old.text_of("type", default="gaussian") == "none"
            rate = Noise() if silent else read_noise(old.first("rate"))
            acceleration = Noise() if silent else read_noise(old.first("accel"))
            self.rate_noise: tuple[Noise, ...] = (rate, rate, rate)
            self.acceleration_noise: tuple[Noise, ...] = (acceleration, acceleration, acceleration)
        else:
            self.rate_noise = _axes(settings.first("angular_velocity"))
            self.acceleration_noise = _axes(settings.first("linear_acceleration"))
        self.with_orientation = settings.flag_of("enable_orientation", default=True)
        self.reference: Quaternion = (0.0, 0.0, 0.0, 1.0)

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """One topic."""
        return {self.topic: ImuSample}

    def start(self) -> Biases:
        """Draw the biases."""
        self._noise = NoiseVector((*self.rate_noise, *self.acceleration_noise))
        return Biases(self._noise.draw_bias(self.random), np.zeros(6), 0)

    def measure(self, now_ns: int) -> Iterable[Sample]:
        """Measure the motion of the sensor's own point."""
        biases, noise = self.memory, self._noise
        biases.wandering = noise.wander(biases.wandering, (now_ns - biases.stamp_ns) * 1e-9, self.random)
        biases.stamp_ns = now_ns
        measured = noise.apply(self._motion(), biases.constant + biases.wandering, self.random)
        yield ImuSample(
            stamp_ns=now_ns,
            topic=self.topic,
            frame_id=self.frame_id,
            orientation=self._orientation(),
            angular_velocity=measured[:3],
            linear_acceleration=measured[3:],
            orientation_covariance=np.zeros(9) if self.with_orientation else -np.eye(3).ravel(),
            angular_velocity_covariance=np.diag(noise.variance[:3]).ravel(),
            linear_acceleration_covariance=np.diag(noise.variance[3:]).ravel(),
        )

    def _motion(self) -> Array:
        """Return true turn rate and specific force (6,) at the sensor, in its axes."""
        rate, force, spin_up = self.link.inertial_motion()
        arm = np.array(self.pose.position)
        if arm.any():
            force = force + np.cross(spin_up, arm) + np.cross(rate, np.cross(rate, arm))
        into_sensor = rotation_matrix(self.pose.orientation).T
        return np.concatenate((into_sensor @ rate, into_sensor @ force))

    def _orientation(self) -> Array:
        if not self.with_orientation:
            return np.array((0.0, 0.0, 0.0, 1.0))
        mount = self.link.pose @ self.pose
        return np.array(multiply(Pose(orientation=self.reference).inverse.orientation, mount.orientation))


def _axes(element: Element | None) -> tuple[Noise, ...]:
    if element is None:
        return Noise(), Noise(), Noise()
    return tuple(read_noise((element.first(axis) or element).first("noise")) for axis in ("x", "y", "z"))
