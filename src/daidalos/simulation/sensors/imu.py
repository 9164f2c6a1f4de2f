"""IMU: angular velocity, specific force and orientation of a link."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.pose3 import Pose, Quaternion, multiply, rotation_matrix
from daidalos.description.markup import Element
from daidalos.samples.sensors import ImuSample, Sample
from daidalos.simulation.noise import Noise, read_noise
from daidalos.simulation.sensors.noisy import Biases, NoisySensor, noise_of_axes


class Imu(NoisySensor):
    """Inertial measurement unit in ROS's conventions (REP 145): at rest it measures +g upwards.

    Attributes
    ----------
    starts_level : bool
        Whether the orientation that it starts with is reported as none; a plugin may set it.
    """

    names = ("imu",)
    default_topic = "imu"
    sample = ImuSample

    def read(self, element: Element) -> None:
        """Read the noise of each axis, in the old and the new notation."""
        settings = element.first("imu") or Element("imu")
        old = settings.first("noise")
        if old is not None:
            silent = old.text_of("type", default="gaussian") == "none"
            rate = Noise() if silent else read_noise(old.first("rate"))
            acceleration = Noise() if silent else read_noise(old.first("accel"))
            self.rate_noise: tuple[Noise, ...] = (rate, rate, rate)
            self.acceleration_noise: tuple[Noise, ...] = (acceleration, acceleration, acceleration)
        else:
            self.rate_noise = noise_of_axes(settings.first("angular_velocity"))
            self.acceleration_noise = noise_of_axes(settings.first("linear_acceleration"))
        self.with_orientation = settings.flag_of("enable_orientation", default=True)
        self.starts_level = False

    @property
    def noises(self) -> tuple[Noise, ...]:
        """Noise of angular velocity and acceleration."""
        return (*self.rate_noise, *self.acceleration_noise)

    def start(self) -> Biases:
        """Draw the biases and compute constant parts of the measurements."""
        biases = super().start()
        self._arm = np.array(self.pose.position) if any(self.pose.position) else None
        self._into_sensor = rotation_matrix(self.pose.orientation).T
        reference = self._mount() if self.starts_level else Pose().orientation
        self._from_reference = Pose(orientation=reference).inverse.orientation
        self._covariances = (
            np.zeros(9) if self.with_orientation else -np.eye(3).ravel(),
            np.diag(self.variance[:3]).ravel(),
            np.diag(self.variance[3:]).ravel(),
        )
        return biases

    def measure(self, now_ns: int) -> Iterable[Sample]:
        """Return the measurement at the sensor's origin."""
        measured = self.apply_noise(self._motion(), now_ns)
        of_orientation, of_rate, of_acceleration = self._covariances
        yield ImuSample(
            stamp_ns=now_ns,
            topic=self.topic,
            frame_id=self.frame_id,
            orientation=self._orientation(),
            angular_velocity=measured[:3],
            linear_acceleration=measured[3:],
            orientation_covariance=of_orientation,
            angular_velocity_covariance=of_rate,
            linear_acceleration_covariance=of_acceleration,
        )

    def _motion(self) -> Array:
        """Return the true angular velocity and specific force (6,) at the sensor, in its axes."""
        rate, force, spin_up = self.link.inertial_motion()
        if self._arm is not None:
            force = force + np.cross(spin_up, self._arm) + np.cross(rate, np.cross(rate, self._arm))
        return np.concatenate((self._into_sensor @ rate, self._into_sensor @ force))

    def _orientation(self) -> Array:
        if not self.with_orientation:
            return np.array((0.0, 0.0, 0.0, 1.0))
        return np.array(multiply(self._from_reference, self._mount()))

    def _mount(self) -> Quaternion:
        """Return the sensor's orientation in the world."""
        return multiply(self.link.pose.orientation, self.pose.orientation)
