"""Magnetometer: the world's magnetic field in the sensor's axes."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from daidalos.common.pose3 import rotate
from daidalos.description.markup import Element
from daidalos.samples.sensors import MagneticFieldSample, Sample
from daidalos.simulation.noise import Noise
from daidalos.simulation.sensors.noisy import NoisySensor, noise_of_axes


class Magnetometer(NoisySensor):
    """Magnetometer [T].

    Attributes
    ----------
    field_noise : tuple of 3 Noise
        A plugin may set another.
    """

    names = ("magnetometer",)
    default_topic = "magnetometer"
    sample = MagneticFieldSample

    def read(self, element: Element) -> None:
        """Read the noise of each axis."""
        self.field_noise: tuple[Noise, ...] = noise_of_axes(element.first("magnetometer"))

    @property
    def noises(self) -> tuple[Noise, ...]:
        """Noise of the three axes."""
        return self.field_noise

    def measure(self, now_ns: int) -> Iterable[Sample]:
        """Return the field in the sensor's axes."""
        mount = self.link.pose @ self.pose
        field = np.array(rotate(mount.inverse.orientation, self.context.world.magnetic_field))
        measured = self.apply_noise(field, now_ns)
        covariance = np.diag(self.variance).ravel()
        yield MagneticFieldSample(now_ns, self.topic, self.frame_id, measured, covariance)
