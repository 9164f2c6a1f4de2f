"""Contracts of what judges trajectories of the MPPI and DWB controllers."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.navigation.contracts.control import ControlInput
from daidalos.navigation.contracts.extension import NavigationExtension
from daidalos.navigation.costmap.footprint import Footprint

if TYPE_CHECKING:
    from daidalos.navigation.controllers.dwb.trajectories import Trajectories
    from daidalos.navigation.controllers.mppi.rollouts import Limits, Rollouts


@dataclass(frozen=True)
class Scene:
    """Inputs of critics beside the rollouts.

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
    limits : Limits
        What the robot can do, under the speed limit.
    """

    control: ControlInput
    footprint: Footprint
    along: Array
    path_free: NDArray[np.bool_]
    furthest: int
    step: float
    limits: Limits

    def next_free(self, index: int) -> int:
        """Return the index of the first free pose of the path from an index on; the last if there is none."""
        last = self.along.size - 1
        index = min(index, last)
        free = np.flatnonzero(self.path_free[index:])
        return index + int(free[0]) if free.size else last


class Critic(NavigationExtension):
    """Cost term of rollouts.

    Attributes
    ----------
    judges_contact : bool
        Whether this critic notes in `rollouts.collides` which samples touch an obstacle.
    """

    judges_contact: bool = False

    @abstractmethod
    def score(self, rollouts: Rollouts, scene: Scene) -> None:
        """Add this critic's costs to `rollouts.costs`."""


class TrajectoryValidator(NavigationExtension):
    """Check of the trajectory that the MPPI controller has chosen, before the robot drives along it."""

    @abstractmethod
    def is_valid(self, trajectory: Array, scene: Scene) -> bool:
        """Return whether the robot may drive along a trajectory.

        Parameters
        ----------
        trajectory : ndarray, shape (n, 3)
            Poses (x, y, yaw) in the costmap's frame, `scene.step` [s] apart.
        scene : Scene
        """


class TrajectoryCritic(NavigationExtension):
    """Cost term of trajectories of constant commands, of which the DWB controller takes the best."""

    def reset(self) -> None:
        """Reset the state of the last task."""

    def note(self, pose: Array, command: Array) -> None:
        """Take note of the command (x [m/s], y [m/s], yaw [rad/s]) that is given at a pose (x, y, yaw)."""

    @abstractmethod
    def score(self, trajectories: Trajectories, scene: TrajectoryScene) -> Array:
        """Return the weighted cost of each trajectory, shape (n,): not negative, infinite where it is impossible."""


@dataclass(frozen=True)
class TrajectoryScene:
    """Inputs of critics of trajectories beside these.

    Attributes
    ----------
    control : ControlInput
        State, path, goal and costmap of the cycle.
    footprint : Footprint
        Outline of the robot.
    xy_goal_tolerance : float
        How near [m] to the goal the robot has to turn to the goal's yaw.
    trans_stopped_velocity : float
        Translational speed [m/s] below which it stands.
    """

    control: ControlInput
    footprint: Footprint
    xy_goal_tolerance: float
    trans_stopped_velocity: float
