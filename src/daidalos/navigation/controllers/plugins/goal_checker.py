"""The contract of a goal checker."""

from abc import ABC, abstractmethod

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class GoalChecker(ABC):
    """Decides whether a goal is reached."""

    @property
    @abstractmethod
    def tolerances(self) -> tuple[float, float]:
        """How near [m] and how well turned [rad] the robot must be."""

    @abstractmethod
    def is_goal_reached(self, pose: Array, goal: Array, velocity: Array) -> bool:
        """Judge a pose (x, y, yaw) and a velocity (x, y, yaw) against a goal in the same frame."""

    @abstractmethod
    def reset(self) -> None:
        """Begin with a new goal."""
