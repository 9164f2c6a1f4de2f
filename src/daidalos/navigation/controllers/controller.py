"""The contract of a controller, what it is told in a cycle, and how it can fail."""

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.errors import NavigationError

Array = NDArray[np.float64]


class ControllerError(NavigationError):
    """The robot can not be driven along the path; the message says why."""


class InvalidPath(ControllerError):
    """The path is empty or does not pass the robot."""

    code = "INVALID_PATH"


class NoValidControl(ControllerError):
    """Every motion that the controller can think of ends in contact."""

    code = "NO_VALID_CONTROL"


class FailedToMakeProgress(ControllerError):
    """The robot did not move as far as it must in the time it is given."""

    code = "FAILED_TO_MAKE_PROGRESS"


class PatienceExceeded(ControllerError):
    """The controller failed for longer than it may."""

    code = "PATIENCE_EXCEEDED"


@dataclass(frozen=True)
class ControlInput:
    """What a controller knows in one cycle; poses are (x, y, yaw) in the costmap's frame.

    Attributes
    ----------
    pose : ndarray, shape (3,)
        Where the robot is.
    velocity : ndarray, shape (3,)
        Its velocity (x [m/s], y [m/s], yaw [rad/s]) in its own frame.
    path : ndarray, shape (n, 3)
        The part of the plan ahead, from the robot as far as the controller looks.
    goal : ndarray, shape (3,)
        End of the whole plan.
    distance_to_goal : float
        Length [m] of the rest of the plan.
    costmap : Costmap
        Inflated costs around the robot.
    circumscribed_cost : int
        Smallest cost at the robot's centre at which some part of it may touch an obstacle.
    xy_goal_tolerance, yaw_goal_tolerance : float
        How near [m], [rad] to the goal is near enough.
    """

    pose: Array
    velocity: Array
    path: Array
    goal: Array
    distance_to_goal: float
    costmap: Costmap
    circumscribed_cost: int = 1
    xy_goal_tolerance: float = 0.25
    yaw_goal_tolerance: float = 0.25


class Controller(ABC):
    """Finds the velocity for the next cycle."""

    @property
    @abstractmethod
    def look_ahead(self) -> float:
        """Length [m] of the path that the controller wants to see."""

    @abstractmethod
    def compute_velocity_commands(self, control: ControlInput) -> Array:
        """Find the velocity for the next cycle.

        Returns
        -------
        ndarray, shape (3,)
            Velocity (x [m/s], y [m/s], yaw [rad/s]) in the robot's frame.

        Raises
        ------
        ControllerError
            There is none.
        """

    @abstractmethod
    def set_speed_limit(self, speed_limit: float, *, percentage: bool) -> None:
        """Drive no faster than a speed [m/s] or a percentage of the maximum; 0 lifts the limit."""

    @abstractmethod
    def reset(self) -> None:
        """Forget the last task."""
