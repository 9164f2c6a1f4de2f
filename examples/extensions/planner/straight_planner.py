"""A planner that knows one path: the straight line."""

from dataclasses import dataclass

import numpy as np

from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.contracts import GlobalPlanner
from daidalos.navigation.costmap.costmap import INSCRIBED_INFLATED_OBSTACLE, NO_INFORMATION
from daidalos.navigation.errors import NoPath
from daidalos.navigation.paths import with_headings


@dataclass(frozen=True)
class StraightPlannerParameters(Parameters):
    """Parameters of the planner."""

    interpolation_resolution: float = parameter(0.05, "Distance between two poses of the path.", unit="m", above=0.0)


class StraightPlanner(GlobalPlanner):
    """Drives straight to the goal, or not at all."""

    Parameters = StraightPlannerParameters

    def create_plan(self, costmap, start, goal):
        length = float(np.hypot(*(goal[:2] - start[:2])))
        count = max(int(np.ceil(length / self.parameters.interpolation_resolution)), 1)
        points = np.linspace(start[:2], goal[:2], count + 1)
        for x, y in points:
            cost = costmap.cost_at(x, y)
            if INSCRIBED_INFLATED_OBSTACLE <= cost < NO_INFORMATION:
                raise NoPath(f"the straight line meets an obstacle at ({x:.2f}, {y:.2f})")
        return with_headings(points, final_heading=float(goal[2]))
