"""Goal checker of position and yaw."""

import math
from dataclasses import dataclass

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.common.pose2 import wrap
from daidalos.navigation.contracts import GoalChecker, NavigationContext


@dataclass(frozen=True)
class SimpleGoalCheckerParameters(Parameters):
    """Parameters of the checker, by their Nav2 names."""

    xy_goal_tolerance: float = parameter(0.25, "Distance to the goal that counts as there.", unit="m", minimum=0.0)
    yaw_goal_tolerance: float = parameter(0.25, "Angle to the goal that counts as there.", unit="rad", minimum=0.0)
    stateful: bool = parameter(True, "Whether the distance is not checked again once it was reached.")


class SimpleGoalChecker(GoalChecker):
    """Goal checker of position, then yaw; a stateful one checks the position only until it was reached."""

    names = ("nav2_controller::SimpleGoalChecker",)
    Parameters = SimpleGoalCheckerParameters
    parameters: SimpleGoalCheckerParameters

    def __init__(
        self, parameters: SimpleGoalCheckerParameters | None = None, context: NavigationContext | None = None
    ) -> None:
        super().__init__(parameters, context)
        self._arrived = False

    @property
    def tolerances(self) -> tuple[float, float]:
        """Implement `GoalChecker.tolerances`."""
        return self.parameters.xy_goal_tolerance, self.parameters.yaw_goal_tolerance

    def is_goal_reached(self, pose: Array, goal: Array, velocity: Array) -> bool:
        """Implement `GoalChecker.is_goal_reached`."""
        away = math.hypot(float(goal[0] - pose[0]), float(goal[1] - pose[1]))
        near = away <= self.parameters.xy_goal_tolerance
        if not near and not (self.parameters.stateful and self._arrived):
            return False
        self._arrived = True
        return abs(float(wrap(goal[2] - pose[2]))) <= self.parameters.yaw_goal_tolerance

    def reset(self) -> None:
        """Implement `GoalChecker.reset`."""
        self._arrived = False
