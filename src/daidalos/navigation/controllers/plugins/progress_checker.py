"""The contract of a progress checker."""

from abc import ABC, abstractmethod

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class ProgressChecker(ABC):
    """Decides whether a robot still gets on."""

    @abstractmethod
    def check(self, pose: Array, now: float) -> bool:
        """Whether the robot, at a pose (x, y, yaw) and a time [s], has moved enough lately."""

    @abstractmethod
    def reset(self) -> None:
        """Begin with a new path."""
