"""Critic of the distance to the goal near the goal."""

from dataclasses import dataclass

import numpy as np

from daidalos.common.kernels import compiled
from daidalos.common.parameters import parameter
from daidalos.navigation.contracts import Critic, Scene
from daidalos.navigation.controllers.mppi.critic_parameters import CriticParameters
from daidalos.navigation.controllers.mppi.rollouts import Rollouts, Samples


@dataclass(frozen=True)
class GoalCriticParameters(CriticParameters):
    """Parameters of the critic, by their Nav2 names."""

    cost_weight: float = parameter(5.0, "Weight of the critic in the cost of a trajectory.", minimum=0.0)
    threshold_to_consider: float = parameter(
        1.4, "Distance to the goal below which the critic works.", unit="m", minimum=0.0
    )


class GoalCritic(Critic):
    """Critic of the mean distance [m] between the points of a rollout and the goal."""

    names = ("mppi::critics::GoalCritic",)
    Parameters = GoalCriticParameters
    parameters: GoalCriticParameters

    def score(self, rollouts: Rollouts, scene: Scene) -> None:
        """Implement `Critic.score`."""
        if scene.control.distance_to_goal > self.parameters.threshold_to_consider:
            return
        x, y = (float(value) for value in scene.control.goal[:2])
        self.parameters.add(rollouts, mean_distance(rollouts.x, rollouts.y, x, y))


@compiled
def mean_distance(x: Samples, y: Samples, goal_x: float, goal_y: float) -> Samples:
    """Return the mean distance of each rollout to a point."""
    gx, gy = np.float32(goal_x), np.float32(goal_y)
    means = np.empty(x.shape[0], dtype=np.float32)
    for b in range(x.shape[0]):
        added = np.float32(0.0)
        for t in range(x.shape[1]):
            dx, dy = x[b, t] - gx, y[b, t] - gy
            added += np.sqrt(dx * dx + dy * dy)
        means[b] = added / x.shape[1]
    return means
