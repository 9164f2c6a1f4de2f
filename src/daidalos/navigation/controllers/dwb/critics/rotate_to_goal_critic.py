"""Critic that ends a drive: within the goal's tolerance stop, then turn to the goal's yaw."""

import math
from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.common.pose2 import wrap
from daidalos.navigation.contracts import NavigationContext, TrajectoryCritic, TrajectoryScene
from daidalos.navigation.controllers.dwb.trajectories import Trajectories

_STANDING = 1e-6
"""Largest translational velocity [m/s] of a command that turns on the spot."""


@dataclass(frozen=True)
class RotateToGoalParameters(Parameters):
    """Parameters of the critic, by their Nav2 names."""

    scale: float = parameter(1.0, "Weight of the critic in the cost of a trajectory.", minimum=0.0)
    slowing_factor: float = parameter(5.0, "Weight of the speed while the robot stops.", minimum=0.0)
    lookahead_time: float = parameter(
        -1.0, "Time of the pose whose yaw is compared with the goal's; the last pose where negative.", unit="s"
    )


class RotateToGoalCritic(TrajectoryCritic):
    """Critic of speed, then of the angle [rad] to the goal's yaw, within the tolerance of the goal's position.

    Once the robot stands within the tolerance, it only turns. Outside of the tolerance every trajectory costs the
    same.
    """

    names = ("dwb_critics::RotateToGoalCritic", "dwb_critics::RotateToGoal")
    Parameters = RotateToGoalParameters
    parameters: RotateToGoalParameters

    def __init__(
        self, parameters: RotateToGoalParameters | None = None, context: NavigationContext | None = None
    ) -> None:
        super().__init__(parameters, context)
        self._is_turning = False

    def reset(self) -> None:
        """Implement `TrajectoryCritic.reset`."""
        self._is_turning = False

    def score(self, trajectories: Trajectories, scene: TrajectoryScene) -> Array:
        """Implement `TrajectoryCritic.score`."""
        p, control = self.parameters, scene.control
        away = control.goal[:2] - control.pose[:2]
        if math.hypot(float(away[0]), float(away[1])) > scene.xy_goal_tolerance:
            return np.zeros(trajectories.counts.size)
        speed = math.hypot(float(control.velocity[0]), float(control.velocity[1]))
        self._is_turning = self._is_turning or speed <= scene.trans_stopped_velocity
        speeds = np.hypot(trajectories.commands[:, 0], trajectories.commands[:, 1])
        angles = np.abs(wrap(trajectories.at_time(p.lookahead_time)[:, 2] - float(control.goal[2])))
        if self._is_turning:
            return np.where(speeds > _STANDING, np.inf, p.scale * angles)
        return np.where(speeds > speed, np.inf, p.scale * (p.slowing_factor * speeds + angles))
