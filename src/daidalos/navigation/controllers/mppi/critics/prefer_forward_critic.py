"""Critic of driving in reverse."""

from dataclasses import dataclass

import numpy as np

from daidalos.common.parameters import parameter
from daidalos.navigation.contracts import Critic, Scene
from daidalos.navigation.controllers.mppi.critic_parameters import CriticParameters
from daidalos.navigation.controllers.mppi.rollouts import Rollouts


@dataclass(frozen=True)
class PreferForwardCriticParameters(CriticParameters):
    """Parameters of the critic, by their Nav2 names."""

    cost_weight: float = parameter(5.0, "Weight of the critic in the cost of a trajectory.", minimum=0.0)
    threshold_to_consider: float = parameter(
        0.5, "Distance to the goal above which the critic works.", unit="m", minimum=0.0
    )


class PreferForwardCritic(Critic):
    """Critic of the distance [m] that a rollout drives in reverse."""

    names = ("mppi::critics::PreferForwardCritic",)
    Parameters = PreferForwardCriticParameters
    parameters: PreferForwardCriticParameters

    def score(self, rollouts: Rollouts, scene: Scene) -> None:
        """Implement `Critic.score`."""
        if scene.control.distance_to_goal < self.parameters.threshold_to_consider:
            return
        reverse = np.maximum(-rollouts.vx, 0.0).sum(axis=1) * np.float32(scene.step)
        self.parameters.add(rollouts, reverse)
