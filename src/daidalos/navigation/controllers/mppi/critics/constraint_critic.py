"""Critic of velocities that the robot cannot drive."""

from dataclasses import dataclass

import numpy as np

from daidalos.common.parameters import parameter
from daidalos.navigation.contracts import Critic, Scene
from daidalos.navigation.controllers.mppi.critic_parameters import CriticParameters
from daidalos.navigation.controllers.mppi.rollouts import Rollouts


@dataclass(frozen=True)
class ConstraintCriticParameters(CriticParameters):
    """Parameters of the critic, by their Nav2 names."""

    cost_weight: float = parameter(4.0, "Weight of the critic in the cost of a trajectory.", minimum=0.0)


class ConstraintCritic(Critic):
    """Critic of the distance [m] that a rollout drives above the robot's speed, or turns inside of its circle.

    Every velocity of a rollout is within its own limits already. What remains is the speed of robots that move
    sideways, whose parts may both be at their limits, and the radius of the curves of robots that steer.
    """

    names = ("mppi::critics::ConstraintCritic",)
    Parameters = ConstraintCriticParameters
    parameters: ConstraintCriticParameters

    def score(self, rollouts: Rollouts, scene: Scene) -> None:
        """Implement `Critic.score`."""
        limits = scene.limits
        speed = np.copysign(np.hypot(rollouts.vx, rollouts.vy), rollouts.vx)
        excess = np.maximum(speed - limits.vx_max, 0.0) + np.maximum(limits.vx_min - speed, 0.0)
        if np.isfinite(limits.curvature_max):
            turns = np.abs(rollouts.wz)
            radius = np.abs(rollouts.vx) / np.maximum(turns, 1e-6)
            excess += np.where(turns > 1e-3, np.maximum(1.0 / limits.curvature_max - radius, 0.0), 0.0)
        self.parameters.add(rollouts, scene.step * excess.sum(axis=1))
