"""The contract of a global planner, and what it says when there is no way."""

from abc import ABC, abstractmethod

import numpy as np
from numpy.typing import NDArray

from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.errors import NavigationError

Array = NDArray[np.float64]


class PlannerError(NavigationError):
    """There is no plan; the message says why."""


class StartOutsideMap(PlannerError):
    """The robot is not on the map."""

    code = "START_OUTSIDE_MAP"


class GoalOutsideMap(PlannerError):
    """The goal is not on the map."""

    code = "GOAL_OUTSIDE_MAP"


class StartOccupied(PlannerError):
    """The robot's centre is on an obstacle and nothing free is near."""

    code = "START_OCCUPIED"


class GoalOccupied(PlannerError):
    """The robot can not stand at the goal."""

    code = "GOAL_OCCUPIED"


class NoPath(PlannerError):
    """Start and goal are free, but nothing connects them."""

    code = "NO_VALID_PATH"


class GlobalPlanner(ABC):
    """Finds a path over a costmap."""

    @abstractmethod
    def create_plan(self, costmap: Costmap, start: Array, goal: Array) -> Array:
        """Find a path.

        Parameters
        ----------
        costmap : Costmap
            Inflated costs.
        start, goal : ndarray, shape (3,)
            Poses (x, y, yaw) in the costmap's frame.

        Returns
        -------
        ndarray, shape (n, 3)
            Poses from the start to the goal, each looking along the path, the last as the goal does.

        Raises
        ------
        PlannerError
            There is no plan; the class and the message say why.
        """
