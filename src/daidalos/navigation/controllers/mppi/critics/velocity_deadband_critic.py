"""Critic of velocities that the robot's drives do not turn into motion."""

from dataclasses import dataclass

import numpy as np

from daidalos.common.parameters import parameter
from daidalos.navigation.contracts import Critic, Scene
from daidalos.navigation.controllers.mppi.critic_parameters import CriticParameters
from daidalos.navigation.controllers.mppi.rollouts import Rollouts


@dataclass(frozen=True)
class VelocityDeadbandCriticParameters(CriticParameters):
    """Parameters of the critic, by their Nav2 names."""

    cost_weight: float = parameter(35.0, "Weight of the critic in the cost of a trajectory.", minimum=0.0)
    deadband_velocities: tuple[float, ...] = parameter(
        (0.0, 0.0, 0.0),
        "Velocities (x [m/s], y [m/s], yaw [rad/s]) below which the robot does not move.",
        length=3,
        minimum=0.0,
    )


class VelocityDeadbandCritic(Critic):
    """Critic of the time [s] that each velocity of a rollout lies in its dead band, times how far within."""

    names = ("mppi::critics::VelocityDeadbandCritic",)
    Parameters = VelocityDeadbandCriticParameters
    parameters: VelocityDeadbandCriticParameters

    def score(self, rollouts: Rollouts, scene: Scene) -> None:
        """Implement `Critic.score`."""
        within = np.zeros(rollouts.costs.shape[0])
        for band, velocity in zip(
            self.parameters.deadband_velocities, (rollouts.vx, rollouts.vy, rollouts.wz), strict=True
        ):
            if band > 0.0:
                within += np.maximum(band - np.abs(velocity), 0.0).sum(axis=1)
        self.parameters.add(rollouts, scene.step * within)
