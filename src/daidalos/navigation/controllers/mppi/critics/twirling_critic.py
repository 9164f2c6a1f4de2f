"""Critic of turning."""

from dataclasses import dataclass

import numpy as np

from daidalos.common.parameters import parameter
from daidalos.navigation.contracts import Critic, Scene
from daidalos.navigation.controllers.mppi.critic_parameters import CriticParameters
from daidalos.navigation.controllers.mppi.rollouts import Rollouts


@dataclass(frozen=True)
class TwirlingCriticParameters(CriticParameters):
    """Parameters of the critic, by their Nav2 names."""

    cost_weight: float = parameter(10.0, "Weight of the critic in the cost of a trajectory.", minimum=0.0)


class TwirlingCritic(Critic):
    """Critic of the mean absolute angular velocity [rad/s] of a rollout, away from the goal."""

    names = ("mppi::critics::TwirlingCritic",)
    Parameters = TwirlingCriticParameters
    parameters: TwirlingCriticParameters

    def score(self, rollouts: Rollouts, scene: Scene) -> None:
        """Implement `Critic.score`."""
        if scene.control.distance_to_goal < scene.control.xy_goal_tolerance:
            return
        self.parameters.add(rollouts, np.abs(rollouts.wz).mean(axis=1))
