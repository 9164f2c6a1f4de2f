"""Trajectories in the plane."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common import pose2
from daidalos.common.arrays import Array

Stamps = NDArray[np.int64]


@dataclass(frozen=True)
class Trajectory:
    """Poses of a robot in the order of their times.

    Attributes
    ----------
    stamps_ns : ndarray of int64, shape (n,), or None
        Times [ns], not decreasing; None where the file has none.
    poses : ndarray, shape (n, 3)
        Poses (x, y, yaw) [m, rad].
    """

    stamps_ns: Stamps | None
    poses: Array


def sorted_trajectory(stamps_ns: list[int], poses: list[Array]) -> Trajectory:
    """Return a trajectory of stamped poses in any order."""
    times = np.array(stamps_ns, dtype=np.int64)
    order = np.argsort(times, kind="stable")
    return Trajectory(times[order], np.array(poses)[order])


def travelled(poses: Array) -> Array:
    """Return the length of the way [m] up to each pose (n,)."""
    steps = pose2.between(poses[:-1], poses[1:])
    return np.concatenate([[0.0], np.cumsum(np.hypot(steps[:, 0], steps[:, 1]))])
