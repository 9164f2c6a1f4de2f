"""Height sensors: altimeter and barometer."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from daidalos.common.pose3 import rotate
from daidalos.description.markup import Element
from daidalos.samples.sensors import AltimeterSample, PressureSample, Sample
from daidalos.simulation.noise import Noise
from daidalos.simulation.sensors.noisy import Biases, NoisySensor, nested_noise

_GRAVITY = 9.80665
_MOLAR_MASS = 0.0289644
_GAS_CONSTANT = 8.3144598


class Altimeter(NoisySensor):
    """Altimeter: height over the start, and its rate."""

    names = ("altimeter",)
    default_topic = "altimeter"
    sample = AltimeterSample

    def read(self, element: Element) -> None:
        """Read the noise of height and speed."""
        settings = element.first("altimeter") or Element("altimeter")
        self._noises = nested_noise(settings, "vertical_position"), nested_noise(settings, "vertical_velocity")
        self._reference = 0.0

    @property
    def noises(self) -> tuple[Noise, ...]:
        """Noise of height and its rate."""
        return self._noises

    def start(self) -> Biases:
        """Record the current height as the reference."""
        self._reference = (self.link.pose @ self.pose).position[2]
        return super().start()

    def measure(self, now_ns: int) -> Iterable[Sample]:
        """Return the height of the sensor."""
        pose = self.link.pose
        linear, angular = self.link.velocity()
        arm = np.array(rotate(pose.orientation, self.pose.position))
        height = pose.position[2] + arm[2] - self._reference
        climb = float((linear + np.cross(angular, arm))[2])
        position, velocity = self.apply_noise(np.array((height, climb)), now_ns).tolist()
        yield AltimeterSample(now_ns, self.topic, self.frame_id, position, velocity, self._reference)


class Barometer(NoisySensor):
    """Barometer: air pressure by the barometric formula with a constant temperature gradient."""

    names = ("air_pressure",)
    default_topic = "air_pressure"
    sample = PressureSample

    def read(self, element: Element) -> None:
        """Read the altitude of the world's origin and the noise."""
        settings = element.first("air_pressure") or Element("air_pressure")
        self._altitude = settings.number_of("reference_altitude", default=0.0)
        self._noises = (nested_noise(settings, "pressure"),)

    @property
    def noises(self) -> tuple[Noise, ...]:
        """Noise of the pressure."""
        return self._noises

    def measure(self, now_ns: int) -> Iterable[Sample]:
        """Return the pressure [Pa]."""
        air = self.context.world.atmosphere
        height = self._altitude + (self.link.pose @ self.pose).position[2]
        exponent = _GRAVITY * _MOLAR_MASS / (_GAS_CONSTANT * -air.temperature_gradient)
        share = max(1 + air.temperature_gradient * height / air.temperature, 0.0)
        pressure = self.apply_noise(np.array((air.pressure * share**exponent,)), now_ns)
        yield PressureSample(now_ns, self.topic, self.frame_id, float(pressure[0]), float(self.variance[0]))
