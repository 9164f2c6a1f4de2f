"""Errors of wheel encoders."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array


@dataclass(frozen=True)
class EncoderError:
    """Error of an encoder relative to the true travel of its wheel.

    Parameters
    ----------
    noise : float
        Standard deviation of the error after one metre [m]; it grows with the square root of the
        distance, whatever the rate of measuring.
    slip : float
        Share of the travel that is measured too much.
    """

    noise: float = 0.0
    slip: float = 0.0

    def measure(self, travel: Array, random: np.random.Generator) -> Array:
        """Return the measured travel of wheels since the last measurement [m]."""
        measured = travel * (1.0 + self.slip)
        if self.noise:
            measured = measured + random.standard_normal(len(travel)) * self.noise * np.sqrt(np.abs(travel))
        return measured
