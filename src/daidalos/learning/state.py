"""State of a robot in an environment, which rewards and observations of the user read."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from daidalos.common.arrays import Array


@dataclass(frozen=True, eq=False)
class State:
    """State after a step.

    Parameters
    ----------
    time : float
        Simulated time since the start of the episode [s].
    x, y, yaw : float
        True pose of the robot in the world [m, rad].
    linear, angular : float
        True velocity: forwards [m/s], to the left [rad/s].
    action : array
        The last action; zeros at the start of an episode.
    collided : bool
        Whether the robot touches anything but the ground.
    ranges : array (rays,)
        Of the lidar [m]; its greatest range where nothing is seen. Empty without lidar.
    joint_positions, joint_velocities : array (joints,)
        Of the joints of the environment [rad, m; rad/s, m/s].
    image : array (height, width, bands) or None
        Of the camera; None without one.
    """

    time: float
    x: float
    y: float
    yaw: float
    linear: float
    angular: float
    action: Array
    collided: bool
    ranges: Array
    joint_positions: Array
    joint_velocities: Array
    image: Any = None

    def __eq__(self, other: object) -> bool:
        """Return whether all values are the same."""
        if not isinstance(other, State):
            return NotImplemented
        return all(np.array_equal(value, vars(other)[name]) for name, value in vars(self).items())

    __hash__ = None  # type: ignore[assignment]
