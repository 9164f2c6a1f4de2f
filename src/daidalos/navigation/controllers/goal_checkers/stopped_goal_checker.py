"""Goal checker of pose and standstill."""

import math
from dataclasses import dataclass

from daidalos.common.arrays import Array
from daidalos.common.parameters import parameter
from daidalos.navigation.controllers.goal_checkers.simple_goal_checker import (
    SimpleGoalChecker,
    SimpleGoalCheckerParameters,
)


@dataclass(frozen=True)
class StoppedGoalCheckerParameters(SimpleGoalCheckerParameters):
    """Parameters of the checker, by their Nav2 names."""

    trans_stopped_velocity: float = parameter(0.25, "Speed that counts as stopped.", unit="m/s", minimum=0.0)
    rot_stopped_velocity: float = parameter(0.25, "Turn rate that counts as stopped.", unit="rad/s", minimum=0.0)


class StoppedGoalChecker(SimpleGoalChecker):
    """Goal checker of the pose as in `SimpleGoalChecker`, and of low velocities."""

    names = ("nav2_controller::StoppedGoalChecker",)
    Parameters = StoppedGoalCheckerParameters
    parameters: StoppedGoalCheckerParameters

    def is_goal_reached(self, pose: Array, goal: Array, velocity: Array) -> bool:
        """Implement `GoalChecker.is_goal_reached`."""
        there = super().is_goal_reached(pose, goal, velocity)
        speed = math.hypot(float(velocity[0]), float(velocity[1]))
        return (
            there
            and speed <= self.parameters.trans_stopped_velocity
            and abs(float(velocity[2])) <= self.parameters.rot_stopped_velocity
        )
