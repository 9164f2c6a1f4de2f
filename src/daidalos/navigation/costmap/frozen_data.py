"""Detection of sensors that repeat the same data while the robot moves."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.pose2 import wrap

_MOVED = 0.05
"""Motion [m, rad] after which data of a sensor that works have changed."""
_JUMP = 0.5
"""Motion [m, rad] between two data that is a correction of the pose."""


class FrozenData:
    """Detection of data that stay the same while the robot moves, as those of a driver that repeats its last scan.

    Noise changes the data of each measurement, and without noise the motion of the robot does. Data in which nothing
    is far enough to be more than a part of the robot are not judged.

    Parameters
    ----------
    own_radius : float
        Distance [m] up to which the robot may see itself.
    """

    def __init__(self, own_radius: float) -> None:
        self._own_radius = own_radius
        self._data: NDArray[np.floating] = np.zeros(0)
        self._last_pose = np.zeros(3)
        self._moved = 0.0

    def repeats(self, data: NDArray[np.floating], distances: NDArray[np.floating], pose: Array) -> bool:
        """Return whether data are the same as before although the robot has moved since they came first.

        Parameters
        ----------
        data : ndarray
            What the sensor measured.
        distances : ndarray
            Distances [m] of what it measured; infinite or not a number for nothing.
        pose : ndarray, shape (3,)
            Pose (x, y, yaw) of the robot at that time, in a frame in which it does not jump.
        """
        step = np.asarray(pose, dtype=np.float64) - self._last_pose
        moved = max(float(np.hypot(step[0], step[1])), abs(float(wrap(step[2]))))
        self._last_pose = np.array(pose, dtype=np.float64)
        if data.shape != self._data.shape or not np.array_equal(data, self._data, equal_nan=True):
            self._data, self._moved = np.array(data), 0.0
            return False
        if not bool(np.any(np.isfinite(distances) & (distances > self._own_radius))):
            return False
        self._moved += moved if moved < _JUMP else 0.0
        return self._moved > _MOVED
