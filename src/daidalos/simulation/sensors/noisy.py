"""Common base of sensors with few values: noise and biases."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.description.markup import Element
from daidalos.simulation.contracts import Sensor
from daidalos.simulation.noise import SILENT, Noise, NoiseVector, read_noise


@dataclass
class Biases:
    """Errors (n,) of n values: constant and drifting ones."""

    constant: Array
    wandering: Array
    stamp_ns: int


class NoisySensor(Sensor):
    """Sensor of n values that are measured together."""

    state: Biases

    @property
    @abstractmethod
    def noises(self) -> Sequence[Noise]:
        """Noise of each value."""

    def start(self) -> Biases:
        """Draw the biases."""
        noises = tuple(self.noises)
        self._noise = NoiseVector(noises)
        return Biases(self._noise.draw_bias(self.random), np.zeros(len(noises)), 0)

    def apply_noise(self, values: Array, now_ns: int) -> Array:
        """Return the values (n,) with noise and bias."""
        biases, noise = self.state, self._noise
        biases.wandering = noise.wander(biases.wandering, (now_ns - biases.stamp_ns) * 1e-9, self.random)
        biases.stamp_ns = now_ns
        return noise.apply(values, biases.constant + biases.wandering, self.random)

    @property
    def variance(self) -> Array:
        """Variance of the noise of each value (n,)."""
        return self._noise.variance


def noise_of_axes(element: Element | None) -> tuple[Noise, Noise, Noise]:
    """Read the noise of ``<x>``, ``<y>`` and ``<z>``, by default that of a common ``<noise>``."""
    if element is None:
        return SILENT, SILENT, SILENT
    x, y, z = (read_noise((element.first(axis) or element).first("noise")) for axis in ("x", "y", "z"))
    return x, y, z


def nested_noise(element: Element, *tags: str) -> Noise:
    """Read the ``<noise>`` below nested elements; none if an element is missing."""
    for tag in tags:
        child = element.first(tag)
        if child is None:
            return SILENT
        element = child
    return read_noise(element.first("noise"))
