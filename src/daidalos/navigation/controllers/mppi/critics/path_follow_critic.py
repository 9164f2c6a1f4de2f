"""Get on along the path: the distance of a rollout's end to a point farther along."""

from dataclasses import dataclass

import numpy as np

from daidalos.navigation.controllers.mppi.critics.critic import Critic, Scene
from daidalos.navigation.controllers.mppi.rollouts import Rollouts


@dataclass(frozen=True)
class PathFollowCriticParameters:
    """Parameters of the critic, by their Nav2 names; the threshold is in metres."""

    cost_weight: float = 5.0
    threshold_to_consider: float = 1.4
    offset_from_furthest: int = 6


class PathFollowCritic(Critic):
    """Adds the distance [m] of a rollout's end to the first free point beyond what any reaches."""

    Parameters = PathFollowCriticParameters

    def __init__(self, parameters: PathFollowCriticParameters | None = None) -> None:
        self.parameters = parameters or PathFollowCriticParameters()

    def score(self, rollouts: Rollouts, scene: Scene) -> None:
        """See `Critic.score`."""
        p = self.parameters
        if scene.control.distance_to_goal < p.threshold_to_consider:
            return
        x, y = scene.control.path[scene.next_free(scene.furthest + p.offset_from_furthest), :2]
        away = np.hypot(rollouts.x[:, -1] - np.float32(x), rollouts.y[:, -1] - np.float32(y))
        rollouts.costs[:] += np.float32(p.cost_weight) * away
