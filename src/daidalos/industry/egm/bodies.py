"""Robots as EGM sees them: up to six axes, and further ones as external axes, in the controller's order."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from daidalos.industry.motion.branches import joints_at
from daidalos.industry.motion.faults import OUT_OF_REACH, MotionFault
from daidalos.industry.motion.kinematics import forward
from daidalos.industry.motion.redundant_kinematics import forward_of, inverse_of
from daidalos.industry.robots import Arm
from daidalos.industry.robots.redundant import RedundantArm
from daidalos.industry.robots.yumi import HOME_DEG

Array = NDArray[np.float64]

AXES = 6
"""Axes that messages call joints; those after them are external ones."""


class Body(Protocol):
    """A robot's axes, in the controller's order, and its kinematics."""

    limits: Array
    speeds: Array
    home: Array

    def pose(self, joints: Array) -> Array:
        """Return the pose of the flange (4, 4) at angles (n,) [rad]."""
        ...

    def joints_at(self, pose: Array, near: Array) -> Array:
        """Return the angles (n,) of a pose of the flange (4, 4) that are nearest to others; raise `MotionFault`."""
        ...


class SixAxes:
    """An arm with a spherical wrist."""

    def __init__(self, arm: Arm) -> None:
        self._arm = arm
        self.limits, self.speeds = arm.limits, arm.speeds
        self.home: Array = np.radians([0.0, 0.0, 0.0, 0.0, 30.0, 0.0])

    def pose(self, joints: Array) -> Array:
        """Return the pose of the flange."""
        return forward(self._arm, joints)

    def joints_at(self, pose: Array, near: Array) -> Array:
        """Return the angles of a pose."""
        return joints_at(self._arm, pose, None, near)


class SevenAxes:
    """An arm with seven axes, whose axis 7 is the first external one."""

    def __init__(self, arm: RedundantArm) -> None:
        self._arm = arm
        self._order = arm.controller_order
        self.limits, self.speeds = arm.limits[self._order], arm.speeds[self._order]
        self.home: Array = np.radians(HOME_DEG["left"])[self._order]

    def _from_base(self, joints: Array) -> Array:
        angles = np.empty(len(joints))
        angles[self._order] = joints
        return angles

    def pose(self, joints: Array) -> Array:
        """Return the pose of the flange."""
        return forward_of(self._arm, self._from_base(joints))[0]

    def joints_at(self, pose: Array, near: Array) -> Array:
        """Return angles of a pose with the arm angle of the others."""
        start = self._from_base(near)
        _, arm_angle = forward_of(self._arm, start)
        found = inverse_of(self._arm, pose, arm_angle, start)
        if not np.isfinite(found).all():
            raise MotionFault(OUT_OF_REACH, "no solution with the same arm angle was found")
        return found[self._order]


def body_of(arm: Arm | RedundantArm) -> Body:
    """Return what EGM needs of an arm."""
    return SevenAxes(arm) if isinstance(arm, RedundantArm) else SixAxes(arm)
