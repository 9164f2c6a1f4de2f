"""Contract of motion models."""

from abc import ABC, abstractmethod

import numpy as np

from daidalos.common.arrays import Array


class MotionModel(ABC):
    """Sampler of poses after a motion."""

    @abstractmethod
    def sample(self, particles: Array, before: Array, after: Array, generator: np.random.Generator) -> Array:
        """Draw a pose for each particle.

        Parameters
        ----------
        particles : ndarray, shape (n, 3)
            Poses (x, y, yaw) before the motion.
        before, after : ndarray, shape (3,)
            Poses that odometry gave before and after it, in a frame of its own.
        generator : numpy.random.Generator
            Source of randomness.

        Returns
        -------
        ndarray, shape (n, 3)
            Poses after the motion.
        """
