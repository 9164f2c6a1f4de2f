"""Motion model of a robot that drives along its heading: rotation, translation, rotation."""

import math

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.pose2 import wrap
from daidalos.localization.config import AmclConfig
from daidalos.localization.motion_models.motion_model import MotionModel

SMALL = 0.01
"""Translation [m] below which its direction says nothing."""


class DifferentialMotionModel(MotionModel):
    """Odometry motion model of Thrun, Burgard and Fox 2005, table 5.6.

    A motion is a turn towards the new position, a translation and a turn to the new heading, each with noise.
    Driving backwards counts as no turn rather than as one of 180 degrees.
    """

    def __init__(self, config: AmclConfig) -> None:
        self.config = config

    def sample(self, particles: Array, before: Array, after: Array, generator: np.random.Generator) -> Array:
        """Implement `MotionModel.sample`."""
        c = self.config
        dx, dy = float(after[0] - before[0]), float(after[1] - before[1])
        distance = math.hypot(dx, dy)
        first = float(wrap(math.atan2(dy, dx) - before[2])) if distance >= SMALL else 0.0
        second = float(wrap(after[2] - before[2] - first))
        turn1, turn2 = _from_axis(first), _from_axis(second)
        count = particles.shape[0]
        noise = generator.standard_normal((3, count))
        first_drawn = first + noise[0] * math.sqrt(c.alpha1 * turn1**2 + c.alpha2 * distance**2)
        drawn = distance + noise[1] * math.sqrt(c.alpha3 * distance**2 + c.alpha4 * (turn1**2 + turn2**2))
        second_drawn = second + noise[2] * math.sqrt(c.alpha1 * turn2**2 + c.alpha2 * distance**2)
        heading = particles[:, 2] + first_drawn
        return np.stack(
            [
                particles[:, 0] + drawn * np.cos(heading),
                particles[:, 1] + drawn * np.sin(heading),
                wrap(heading + second_drawn),
            ],
            axis=-1,
        )


def _from_axis(angle: float) -> float:
    """Return the angle from the nearer of forwards and backwards [rad]."""
    return min(abs(angle), abs(float(wrap(angle - math.pi))))
