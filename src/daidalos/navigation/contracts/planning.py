"""Contracts of planners and smoothers."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable

from daidalos.common.arrays import Array
from daidalos.navigation.contracts.extension import NavigationExtension
from daidalos.navigation.costmap.costmap import Costmap


def _never() -> bool:
    return False


class GlobalPlanner(NavigationExtension):
    """Planner of a path over a costmap.

    Attributes
    ----------
    is_cancelled : callable
        Returns whether the plan is no longer wanted; long searches call it now and then and raise `PlanningCancelled`.
    """

    is_cancelled: Callable[[], bool] = staticmethod(_never)

    @abstractmethod
    def create_plan(self, costmap: Costmap, start: Array, goal: Array) -> Array:
        """Plan a path.

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


class Smoother(NavigationExtension):
    """Smoother of a path that keeps it free of obstacles."""

    @abstractmethod
    def smooth(self, path: Array, costmap: Costmap) -> Array:
        """Smooth a path.

        Parameters
        ----------
        path : ndarray, shape (n, 3)
            Poses (x, y, yaw) in the costmap's frame.
        costmap : Costmap
            Inflated costs.

        Returns
        -------
        ndarray, shape (n, 3)
            Poses with the same first and last position, each looking along the path.
        """
