"""Motion model of a robot that drives along its heading: rotation, translation, rotation."""

import math

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.common.pose2 import wrap
from daidalos.localization.config import AmclConfig
from daidalos.localization.motion_models.motion_model import MotionModel

SMALL = 0.01
"""Translation [m] below which its direction says nothing."""


class DifferentialMotionModel(MotionModel):
    """Odometry motion model of Thrun, Burgard and Fox 2005, table 5.6.

    A motion is a turn towards the new position, a translation and a turn to the new heading, each with noise.
    Driving backwards counts as no turn rather than as one of 180 degrees.

    Parameters
    ----------
    config : AmclConfig
        Its ``alpha1`` to ``alpha4`` are used.
    corrected : bool
        Whether the sums of the alphas are variances, as in the book, in Nav2 and in ROS 1's ``diff-corrected``; in
        ROS 1's ``diff`` they are standard deviations.
    """

    def __init__(self, config: AmclConfig, *, corrected: bool = True) -> None:
        self.config = config
        self._deviation = math.sqrt if corrected else float

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
        first_drawn = first + noise[0] * self._deviation(c.alpha1 * turn1**2 + c.alpha2 * distance**2)
        drawn = distance + noise[1] * self._deviation(c.alpha3 * distance**2 + c.alpha4 * (turn1**2 + turn2**2))
        second_drawn = second + noise[2] * self._deviation(c.alpha1 * turn2**2 + c.alpha2 * distance**2)
        return moved(particles, first_drawn, drawn, second_drawn)


@compiled
def moved(particles: Array, first: Array, distance: Array, second: Array) -> Array:
    """Return particles (n, 3) after a turn, a translation along the new heading and another turn, each (n,)."""
    result = np.empty_like(particles)
    for i in range(particles.shape[0]):
        heading = particles[i, 2] + first[i]
        result[i, 0] = particles[i, 0] + distance[i] * math.cos(heading)
        result[i, 1] = particles[i, 1] + distance[i] * math.sin(heading)
        result[i, 2] = (heading + second[i] + math.pi) % (2.0 * math.pi) - math.pi
    return result


def _from_axis(angle: float) -> float:
    """Return the angle from the nearer of forwards and backwards [rad]."""
    return min(abs(angle), abs(float(wrap(angle - math.pi))))
