"""Look along the path: the angle between a rollout's end and a point a little ahead."""

import math
from dataclasses import dataclass

import numpy as np

from daidalos.common.pose2 import between, wrap
from daidalos.navigation.controllers.mppi.critics.critic import Critic, Scene
from daidalos.navigation.controllers.mppi.rollouts import Rollouts


@dataclass(frozen=True)
class PathAngleCriticParameters:
    """Parameters of the critic, by their Nav2 names; metres and radians."""

    cost_weight: float = 2.0
    threshold_to_consider: float = 0.5
    offset_from_furthest: int = 4
    max_angle_to_furthest: float = 0.785


class PathAngleCritic(Critic):
    """Adds the angle [rad] between a rollout's last heading and the path, when the robot looks away."""

    Parameters = PathAngleCriticParameters

    def __init__(self, parameters: PathAngleCriticParameters | None = None) -> None:
        self.parameters = parameters or PathAngleCriticParameters()

    def score(self, rollouts: Rollouts, scene: Scene) -> None:
        """See `Critic.score`."""
        p = self.parameters
        if scene.control.distance_to_goal < p.threshold_to_consider:
            return
        target = scene.control.path[scene.next_free(scene.furthest + p.offset_from_furthest)]
        ahead = between(scene.control.pose, target)
        if abs(math.atan2(float(ahead[1]), float(ahead[0]))) < p.max_angle_to_furthest:
            return
        bearing = np.arctan2(np.float32(target[1]) - rollouts.y[:, -1], np.float32(target[0]) - rollouts.x[:, -1])
        angle = np.abs(wrap(bearing - rollouts.yaw[:, -1]))
        rollouts.costs[:] += (p.cost_weight * angle).astype(np.float32)
