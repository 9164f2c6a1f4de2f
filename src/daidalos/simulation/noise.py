"""Sensor noise of SDF's ``<noise>``."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.description.markup import Element


@dataclass(frozen=True)
class Noise:
    """Gaussian noise with a constant bias and an optional random walk.

    Parameters
    ----------
    mean, stddev : float
        Of what is added to each number, in the number's unit.
    bias_mean, bias_stddev : float
        Of the constant error; its sign is drawn too.
    dynamic_bias_stddev, dynamic_bias_correlation_time : float
        Of the part of the error that wanders (a Gauss-Markov process) [unit, s].
    precision : float
        Numbers are rounded to multiples of it; 0 leaves them.
    """

    mean: float = 0.0
    stddev: float = 0.0
    bias_mean: float = 0.0
    bias_stddev: float = 0.0
    dynamic_bias_stddev: float = 0.0
    dynamic_bias_correlation_time: float = 0.0
    precision: float = 0.0

    def apply(self, values: Array, random: np.random.Generator) -> Array:
        """Return the values with noise but without bias; infinite values stay."""
        noisy = values
        if self.mean or self.stddev:
            noisy = noisy + random.normal(self.mean, self.stddev, len(values))
        if self.precision:
            noisy = np.round(noisy / self.precision) * self.precision
        return noisy


SILENT = Noise()


class NoiseVector:
    """Noise of n values that are measured together, each with its own settings.

    Parameters
    ----------
    noises : sequence of Noise
    """

    def __init__(self, noises: Sequence[Noise]) -> None:
        self._mean = np.array([noise.mean for noise in noises])
        self._stddev = np.array([noise.stddev for noise in noises])
        self._bias_mean = np.array([noise.bias_mean for noise in noises])
        self._bias_stddev = np.array([noise.bias_stddev for noise in noises])
        self._wander_stddev = np.array([noise.dynamic_bias_stddev for noise in noises])
        times = np.array([noise.dynamic_bias_correlation_time for noise in noises])
        self._wander_time = np.where(times > 0, times, np.inf)
        self._precision = np.array([noise.precision for noise in noises])
        self._wanders = bool(np.any((self._wander_stddev > 0) & (times > 0)))
        self._rounded = self._precision > 0

    @property
    def variance(self) -> Array:
        """Variance of the white noise (n,)."""
        variance: Array = np.square(self._stddev)
        return variance

    def draw_bias(self, random: np.random.Generator) -> Array:
        """Draw the constant errors (n,) with random signs."""
        signs: Array = random.choice((-1.0, 1.0), len(self._mean))
        return random.normal(self._bias_mean, self._bias_stddev) * signs

    def wander(self, bias: Array, elapsed: float, random: np.random.Generator) -> Array:
        """Return the drifting errors (n,) after `elapsed` seconds.

        Exact discretization of a Gauss-Markov process whose stationary standard deviation is
        ``dynamic_bias_stddev`` (Crassidis, "Sigma-point Kalman filtering for integrated GPS and inertial
        navigation", 2006).
        """
        if not self._wanders:
            return bias
        decay: Array = np.exp(-elapsed / self._wander_time)
        change: Array = random.normal(0.0, self._wander_stddev * np.sqrt(1 - np.square(decay)))
        return decay * bias + change

    def apply(self, values: Array, bias: Array, random: np.random.Generator) -> Array:
        """Return the values (n,) with noise and bias."""
        noisy = values + bias + random.normal(self._mean, self._stddev)
        if self._rounded.any():
            steps = np.where(self._rounded, self._precision, 1.0)
            noisy = np.where(self._rounded, np.round(noisy / steps) * steps, noisy)
        return noisy


def read_noise(element: Element | None) -> Noise:
    """Read ``<noise>``, or ``<rate>`` and ``<accel>`` of an older IMU; None yields no noise."""
    if element is None or element.attribute("type", element.text_of("type", default="gaussian")) == "none":
        return Noise()
    for tag in ("stddev", "bias_stddev", "dynamic_bias_stddev"):
        if element.number_of(tag, default=0.0) < 0:
            raise element.error(f"<{tag}> should not be negative")
    return Noise(
        mean=element.number_of("mean", default=0.0),
        stddev=element.number_of("stddev", default=0.0),
        bias_mean=element.number_of("bias_mean", default=0.0),
        bias_stddev=element.number_of("bias_stddev", default=0.0),
        dynamic_bias_stddev=element.number_of("dynamic_bias_stddev", default=0.0),
        dynamic_bias_correlation_time=element.number_of("dynamic_bias_correlation_time", default=0.0),
        precision=element.number_of("precision", default=0.0),
    )
