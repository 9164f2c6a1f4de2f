"""Motion model of a robot that drives in any direction."""

import math

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.pose2 import between, wrap
from daidalos.localization.config import AmclConfig
from daidalos.localization.motion_models.motion_model import MotionModel


class OmniMotionModel(MotionModel):
    """Motion model of a noisy translation along and across the measured direction, and a noisy rotation.

    Parameters
    ----------
    config : AmclConfig
        Its ``alpha1`` to ``alpha5`` are used.
    corrected : bool
        As in `DifferentialMotionModel`; False is ROS 1's ``omni``.
    """

    def __init__(self, config: AmclConfig, *, corrected: bool = True) -> None:
        self.config = config
        self._deviation = math.sqrt if corrected else float

    def sample(self, particles: Array, before: Array, after: Array, generator: np.random.Generator) -> Array:
        """Implement `MotionModel.sample`."""
        c = self.config
        step = between(before, after)
        distance, turn = math.hypot(float(step[0]), float(step[1])), float(step[2])
        direction = particles[:, 2] + math.atan2(float(step[1]), float(step[0]))
        noise = generator.standard_normal((3, particles.shape[0]))
        along = distance + noise[0] * self._deviation(c.alpha3 * distance**2 + c.alpha1 * turn**2)
        across = noise[1] * self._deviation(c.alpha1 * turn**2 + c.alpha5 * distance**2)
        turned = turn + noise[2] * self._deviation(c.alpha4 * turn**2 + c.alpha2 * distance**2)
        cosine, sine = np.cos(direction), np.sin(direction)
        return np.stack(
            [
                particles[:, 0] + along * cosine - across * sine,
                particles[:, 1] + along * sine + across * cosine,
                wrap(particles[:, 2] + turned),
            ],
            axis=-1,
        )
