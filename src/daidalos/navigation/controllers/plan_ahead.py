"""Part of a plan ahead of the robot."""

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.pose2 import between, compose, wrap
from daidalos.navigation.errors import InvalidPath
from daidalos.navigation.paths import distances_along, split_at_cusps

SAME_PLACE = 1e-3
"""Distance [m] between two poses of a plan below which the robot turns in place."""


class PlanAhead:
    """Plan without the part that the robot has passed.

    The robot is looked for only a limited way along the plan, so that where a plan comes near to itself the
    robot does not jump from one part to the other.

    Parameters
    ----------
    max_robot_pose_search_dist : float
        How far [m] along the plan the robot may have got since the last cycle.
    has_cusps : bool
        Whether the robot has to come to cusps of the plan before it sees what follows.
    rotation_angle : float, optional
        Angle [rad] from which on the same holds for turns in place; for all with cusps where left out.
    """

    def __init__(
        self, max_robot_pose_search_dist: float = 1.5, *, has_cusps: bool = True, rotation_angle: float | None = None
    ) -> None:
        self._has_cusps, self._rotation_angle = has_cusps, rotation_angle
        self.max_robot_pose_search_dist = max_robot_pose_search_dist
        self._plan = np.zeros((0, 3))
        self._along = np.zeros(0)
        self._passed = 0
        self._cusps: list[int] = []

    @property
    def has_plan(self) -> bool:
        """Whether there is a plan."""
        return self._plan.shape[0] > 0

    def set_plan(self, plan: Array) -> None:
        """Set the plan (n, 3) with its frame.

        Raises
        ------
        InvalidPath
            It has no poses, or one that is not finite.
        """
        if plan.ndim != 2 or plan.shape[0] == 0 or plan.shape[1] != 3:
            raise InvalidPath(f"a path must be at least one pose (x, y, yaw), not an array of shape {plan.shape}")
        if not np.isfinite(plan).all():
            raise InvalidPath("the path has a pose that is not finite")
        self._plan = plan.copy()
        self._along = distances_along(plan)
        self._passed = 0
        self._cusps = self._stops(plan) if plan.shape[0] > 2 else []

    def _stops(self, plan: Array) -> list[int]:
        """Return the poses that the robot has to come to before it sees what follows."""
        if self._rotation_angle is None:
            stops: list[int] = np.cumsum([part.shape[0] - 1 for part in split_at_cusps(plan)])[:-1].tolist()
            return stops
        steps = np.diff(plan[:, :2], axis=0)
        reversals = np.flatnonzero(np.sum(steps[:-1] * steps[1:], axis=1) < 0.0) + 1
        return sorted({*(reversals.tolist() if self._has_cusps else ()), *self._turns(plan, self._rotation_angle)})

    def _turns(self, plan: Array, least: float) -> list[int]:
        """Return the poses at which turns in place by at least an angle [rad] end."""
        stays = np.hypot(*np.diff(plan[:, :2], axis=0).T) < SAME_PLACE
        ends = []
        turned = 0.0
        for index, stay in enumerate(stays.tolist()):
            turned = turned + float(wrap(plan[index + 1, 2] - plan[index, 2])) if stay else 0.0
            is_last = index + 1 == stays.size or not stays[index + 1]
            if stay and is_last and abs(turned) >= least:
                ends.append(index + 1)
        return ends

    def ahead(
        self, pose: Array, plan_frame: Array, look_ahead: float, inversion: tuple[float, float] | None = None
    ) -> tuple[Array, Array, float]:
        """Return the part of the plan ahead of the robot, and drop the part behind.

        Parameters
        ----------
        pose : ndarray, shape (3,)
            Pose of the robot in the costmap's frame.
        plan_frame : ndarray, shape (3,)
            Pose of the plan's frame in the costmap's frame.
        look_ahead : float
            How much [m] of the path is wanted.
        inversion : tuple of float, optional
            How near [m], [rad] the robot has to come to a cusp of the plan before it sees what follows; it sees past
            cusps where left out.

        Returns
        -------
        path : ndarray, shape (n, 3)
            The next poses of the plan in the costmap's frame, at least one.
        goal : ndarray, shape (3,)
            Its last pose in the costmap's frame.
        distance : float
            Length [m] of all that is left of the plan.
        """
        start = self._along[self._passed]
        limit = self._next_cusp(pose, plan_frame, inversion)
        end = int(np.searchsorted(self._along, start + self.max_robot_pose_search_dist, side="right"))
        end = min(end, limit + 1)
        near = compose(plan_frame, self._plan[self._passed : end])
        away = np.hypot(near[:, 0] - pose[0], near[:, 1] - pose[1])
        self._passed += int(np.argmin(away))
        start = self._along[self._passed]
        end = min(int(np.searchsorted(self._along, start + look_ahead, side="right")), limit + 1)
        path = compose(plan_frame, self._plan[self._passed : max(end, self._passed + 1)])
        goal = compose(plan_frame, self._plan[-1])
        return path, goal, float(self._along[-1] - start)

    def _next_cusp(self, pose: Array, plan_frame: Array, inversion: tuple[float, float] | None) -> int:
        """Return the index of the cusp that the robot has yet to reach, or of the plan's last pose."""
        last = self._plan.shape[0] - 1
        if inversion is None:
            return last
        while self._cusps:
            cusp = self._cusps[0]
            if self._passed < cusp:
                away = between(pose, compose(plan_frame, self._plan[cusp]))
                if np.hypot(away[0], away[1]) > inversion[0] or abs(float(away[2])) > inversion[1]:
                    return cusp
                self._passed = cusp
            self._cusps.pop(0)
        return last
