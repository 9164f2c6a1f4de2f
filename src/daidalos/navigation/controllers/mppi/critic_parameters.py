"""Parameters that most critics share, and how a measure becomes a cost."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from daidalos.common.parameters import Parameters, parameter

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from daidalos.navigation.controllers.mppi.rollouts import Rollouts


@dataclass(frozen=True)
class CriticParameters(Parameters):
    """Weight and power of a critic, by their Nav2 names."""

    cost_weight: float = parameter(5.0, "Weight of the critic in the cost of a trajectory.", minimum=0.0)
    cost_power: int = parameter(1, "Power that the weighted cost is raised to.", minimum=1)

    def add(self, rollouts: Rollouts, measures: NDArray[np.floating]) -> None:
        """Add ``(cost_weight * measure)^cost_power`` to the cost of each rollout.

        Parameters
        ----------
        rollouts : Rollouts
        measures : ndarray, shape (batch,)
            What the critic measured of each rollout.
        """
        costs = self.cost_weight * measures
        rollouts.costs[:] += (costs if self.cost_power == 1 else costs**self.cost_power).astype(np.float32)
