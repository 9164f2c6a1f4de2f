"""Contracts of controllers, and of the checkers that go with them."""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.navigation.contracts.extension import NavigationExtension
from daidalos.navigation.contracts.topics import Output
from daidalos.navigation.costmap.costmap import Costmap


@dataclass(frozen=True)
class ControlInput:
    """Inputs of a controller in one cycle; poses are (x, y, yaw) in the costmap's frame.

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


class Controller(NavigationExtension):
    """Controller that computes the velocity of the next cycle."""

    @property
    @abstractmethod
    def look_ahead(self) -> float:
        """Length [m] of the path that the controller uses."""

    @property
    def inversion_tolerances(self) -> tuple[float, float] | None:
        """How near [m], [rad] to a cusp of the path the robot has to come before it reverses; None for any distance."""
        return None

    @abstractmethod
    def compute_velocity_commands(self, control: ControlInput) -> Array:
        """Compute the velocity of the next cycle.

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
        """Limit the speed to a value [m/s] or a percentage of the maximum; 0 removes the limit."""

    @abstractmethod
    def reset(self) -> None:
        """Reset the state of the last task."""

    @property
    def outputs(self) -> tuple[Output, ...]:
        """What is shown of the last cycle in the costmap's frame: paths (n, 3) as `numpy.ndarray`, and `Candidates`."""
        return ()


@dataclass(frozen=True)
class Candidates:
    """Trajectories of which a controller has chosen, to be shown.

    Attributes
    ----------
    points : ndarray, shape (n, m, 2)
        The points [m] of each.
    costs : ndarray, shape (n,)
        How good they are; the least is the best.
    """

    points: NDArray[np.floating[Any]]
    costs: NDArray[np.floating[Any]]


class PathHandler(NavigationExtension):
    """Choice of how much of a plan the controller sees, in place of the controller's own."""

    @property
    @abstractmethod
    def look_ahead(self) -> float:
        """Length [m] of the path ahead that the controller sees."""

    @property
    def search_distance(self) -> float:
        """How far [m] along the plan the robot may have got since the last cycle."""
        return 1.5

    @property
    def sees_past_cusps(self) -> bool:
        """Whether the controller sees what follows a cusp before the robot is there."""
        return True

    @property
    def rotation_angle(self) -> float:
        """Angle [rad] from which on the robot has to make a turn in place before it sees what follows it."""
        return math.inf

    @property
    def tolerances(self) -> tuple[float, float]:
        """How near [m], [rad] to a cusp or turn the robot has to come."""
        return 0.2, 0.4

    def check(self, plan: Array) -> None:
        """Check a plan (n, 3).

        Raises
        ------
        InvalidPath
            It cannot be followed.
        """


class GoalChecker(NavigationExtension):
    """Check of whether a goal is reached."""

    @property
    @abstractmethod
    def tolerances(self) -> tuple[float, float]:
        """Tolerances of position [m] and yaw [rad]."""

    @abstractmethod
    def is_goal_reached(self, pose: Array, goal: Array, velocity: Array) -> bool:
        """Return whether a pose (x, y, yaw) and a velocity (x, y, yaw) fulfil a goal in the same frame."""

    @abstractmethod
    def reset(self) -> None:
        """Reset for a new goal."""


class ProgressChecker(NavigationExtension):
    """Check of whether a robot makes progress."""

    @abstractmethod
    def check(self, pose: Array, now: float) -> bool:
        """Return whether the robot, at a pose (x, y, yaw) and a time [s], has moved enough recently."""

    @abstractmethod
    def reset(self) -> None:
        """Reset for a new path."""
