"""The contract of a critic, and what it is told."""

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.navigation.controllers.controller import ControlInput
from daidalos.navigation.controllers.mppi.rollouts import Rollouts
from daidalos.navigation.costmap.footprint import Footprint

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Scene:
    """What critics know beside the rollouts.

    Attributes
    ----------
    control : ControlInput
        State, path, goal and costmap of the cycle.
    footprint : Footprint
        Outline of the robot.
    along : ndarray, shape (n,)
        Distance [m] along the path of each of its poses.
    path_free : ndarray of bool, shape (n,)
        Whether the robot's centre may be at each pose of the path.
    furthest : int
        Pose of the path farthest along that any rollout ends near to.
    step : float
        Length of a step of the rollouts [s].
    """

    control: ControlInput
    footprint: Footprint
    along: Array
    path_free: NDArray[np.bool_]
    furthest: int
    step: float

    def next_free(self, index: int) -> int:
        """First pose of the path, from an index on, at which the robot may be; the last if there is none."""
        last = self.along.size - 1
        index = min(index, last)
        free = np.flatnonzero(self.path_free[index:])
        return index + int(free[0]) if free.size else last


class Critic(ABC):
    """Gives each rollout a cost for one thing.

    Attributes
    ----------
    judges_contact : bool
        Whether this critic notes in `rollouts.collides` which samples touch an obstacle.
    """

    judges_contact: bool = False

    @abstractmethod
    def score(self, rollouts: Rollouts, scene: Scene) -> None:
        """Add this critic's costs to `rollouts.costs`."""
