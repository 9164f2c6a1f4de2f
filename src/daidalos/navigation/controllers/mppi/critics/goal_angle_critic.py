"""Critic of the angle to the goal's yaw near the goal."""

import math
from dataclasses import dataclass

import numpy as np

from daidalos.common.parameters import parameter
from daidalos.common.pose2 import wrap
from daidalos.navigation.contracts import Critic, Scene
from daidalos.navigation.controllers.mppi.critic_parameters import CriticParameters
from daidalos.navigation.controllers.mppi.rollouts import Rollouts


@dataclass(frozen=True)
class GoalAngleCriticParameters(CriticParameters):
    """Parameters of the critic, by their Nav2 names."""

    cost_weight: float = parameter(3.0, "Weight of the critic in the cost of a trajectory.", minimum=0.0)
    threshold_to_consider: float = parameter(
        0.5, "Distance to the goal below which the critic works.", unit="m", minimum=0.0
    )


class GoalAngleCritic(Critic):
    """Critic of the mean absolute angle [rad] between a rollout's headings and the goal's.

    Only within the goal's tolerance, whatever the threshold: a robot that cannot move sideways and has turned
    too early stands beside the goal for ever.
    """

    names = ("mppi::critics::GoalAngleCritic",)
    Parameters = GoalAngleCriticParameters
    parameters: GoalAngleCriticParameters

    def score(self, rollouts: Rollouts, scene: Scene) -> None:
        """Implement `Critic.score`."""
        goal, pose = scene.control.goal, scene.control.pose
        away = math.hypot(float(goal[0] - pose[0]), float(goal[1] - pose[1]))
        if away > min(self.parameters.threshold_to_consider, scene.control.xy_goal_tolerance):
            return
        angle = np.abs(wrap(rollouts.yaw - float(scene.control.goal[2])))
        self.parameters.add(rollouts, angle.mean(axis=1))
