"""Following of an object at a distance: where it is, and where the robot should be."""

from __future__ import annotations

import math

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.pose2 import wrap


class FilteredPose:
    """Low-pass filter of the poses (x, y, yaw) of an object.

    Parameters
    ----------
    coefficient : float
        Share of the newest pose; 0 for no filter.
    timeout : float
        Time [s] without poses after which the filter begins anew.
    """

    def __init__(self, coefficient: float, timeout: float) -> None:
        self._coefficient, self._timeout = coefficient, timeout
        self.pose: Array | None = None
        self.stamp = -math.inf

    def take(self, pose: Array, stamp: float) -> None:
        """Take a pose that was seen at a time [s]; one that was taken already, or is older, changes nothing."""
        if stamp <= self.stamp:
            return
        if self.pose is None or self._coefficient <= 0.0 or stamp - self.stamp > self._timeout:
            self.pose = np.array(pose, float)
        else:
            apart = pose - self.pose
            apart[2] = wrap(apart[2])
            self.pose = self.pose + self._coefficient * apart
        self.stamp = stamp


def pose_at_distance(thing: Array, robot: Array, distance: float, *, skip_orientation: bool) -> Array:
    """Return the pose from which a robot looks at an object from a distance.

    Parameters
    ----------
    thing, robot : ndarray, shape (3,)
        Poses (x, y, yaw).
    distance : float
        [m]; the pose is beyond the object where it is negative.
    skip_orientation : bool
        Whether to look at it from where the robot is, instead of along its heading.
    """
    yaw = float(thing[2])
    if skip_orientation:
        yaw = math.atan2(thing[1] - robot[1], thing[0] - robot[0])
    return np.array([thing[0] - distance * math.cos(yaw), thing[1] - distance * math.sin(yaw), yaw])


def is_reached(
    target: Array,
    robot: Array,
    thing: Array,
    linear_tolerance: float,
    angular_tolerance: float,
    *,
    skip_orientation: bool,
) -> bool:
    """Return whether a robot is at a pose before an object, or nearer to it and looks at it, where that is enough.

    Parameters
    ----------
    target, robot, thing : ndarray, shape (3,)
        Poses (x, y, yaw) of `pose_at_distance`, of the robot, and of the object.
    linear_tolerance, angular_tolerance : float
        [m], [rad].
    skip_orientation : bool
        Whether the robot may be anywhere around the object.
    """
    apart = float(np.hypot(*(target - robot)[:2]))
    is_near = skip_orientation and np.hypot(*(thing - robot)[:2]) <= np.hypot(*(thing - target)[:2])
    return (apart < linear_tolerance or bool(is_near)) and abs(float(wrap(target[2] - robot[2]))) < angular_tolerance
