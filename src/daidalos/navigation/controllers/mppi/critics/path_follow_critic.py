"""Critic of the progress along the path."""

from dataclasses import dataclass

import numpy as np

from daidalos.common.parameters import parameter
from daidalos.navigation.contracts import Critic, Scene
from daidalos.navigation.controllers.mppi.critic_parameters import CriticParameters
from daidalos.navigation.controllers.mppi.rollouts import Rollouts


@dataclass(frozen=True)
class PathFollowCriticParameters(CriticParameters):
    """Parameters of the critic, by their Nav2 names."""

    cost_weight: float = parameter(5.0, "Weight of the critic in the cost of a trajectory.", minimum=0.0)
    threshold_to_consider: float = parameter(
        1.4, "Distance to the goal above which the critic works.", unit="m", minimum=0.0
    )
    offset_from_furthest: int = parameter(
        6, "Number of path points beyond the furthest reached one that trajectories are drawn to.", minimum=0
    )


class PathFollowCritic(Critic):
    """Critic of the distance [m] of a rollout's end to the first free point beyond all rollouts."""

    names = ("mppi::critics::PathFollowCritic",)
    Parameters = PathFollowCriticParameters
    parameters: PathFollowCriticParameters

    def score(self, rollouts: Rollouts, scene: Scene) -> None:
        """Implement `Critic.score`."""
        p = self.parameters
        if scene.control.distance_to_goal < p.threshold_to_consider:
            return
        x, y = scene.control.path[scene.next_free(scene.furthest + p.offset_from_furthest), :2]
        away = np.hypot(rollouts.x[:, -1] - np.float32(x), rollouts.y[:, -1] - np.float32(y))
        p.add(rollouts, away)
