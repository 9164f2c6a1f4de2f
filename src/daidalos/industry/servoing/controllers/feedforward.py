"""Feed-forward of the measured seam: the robot is sent to where the seam will be when it has followed."""

from __future__ import annotations

import numpy as np

from daidalos.industry.servoing.contracts import Observation, SeamController


class FeedforwardController(SeamController):
    """Inverse of the robot, to second order, on the seam ahead.

    A robot 1 / (1 + 2 d s/w + s^2/w^2) with d near 0.7 is behind by the time 2 d/w, up to the second order of s: the
    seam that far ahead is the command.
    """

    names = ("feedforward",)

    def step(self, observation: Observation) -> float:
        """Return what is missing to the seam ahead; see `SeamController.step`."""
        model = self.setup.model
        ahead = 2.0 * model.damping / model.natural_frequency
        seam = observation.seam(np.array([observation.s + self.setup.speed * ahead]))
        return float(seam[0]) - observation.commanded
