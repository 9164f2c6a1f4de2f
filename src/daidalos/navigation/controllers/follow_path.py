"""Path following by a controller with its checkers."""

from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.navigation.contracts import ControlInput, Controller, GoalChecker, PathHandler, ProgressChecker
from daidalos.navigation.controllers.plan_ahead import PlanAhead
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.errors import (
    ControllerError,
    FailedToMakeProgress,
    InvalidPath,
    NoValidControl,
    PatienceExceeded,
)

SAME_FRAME = np.zeros(3)


@dataclass(frozen=True)
class FollowPathStep:
    """Result of one cycle.

    Attributes
    ----------
    velocity : ndarray, shape (3,)
        Velocity command (x [m/s], y [m/s], yaw [rad/s]) in the robot's frame.
    done : bool
        Whether the goal is reached; the velocity is zero then.
    distance_to_goal : float
        Length [m] of the rest of the path.
    path : ndarray, shape (n, 3)
        What the controller saw of the path, in the costmap's frame.
    failure : str
        Why the robot has to stand in this cycle; empty where it does not.
    """

    velocity: Array
    done: bool
    distance_to_goal: float
    path: Array
    failure: str = ""


class FollowPath:
    """Execution of the `follow_path` action.

    Parameters
    ----------
    controller : Controller
        Finds velocities.
    goal_checker : GoalChecker
        Says when the goal is reached.
    progress_checker : ProgressChecker
        Says when the robot is stuck.
    failure_tolerance : float
        How long [s] the controller may fail before the task does; -1 for ever, 0 not at all.
    path_handler : PathHandler, optional
        Says how much of the path the controller sees; the controller itself does where left out.
    """

    def __init__(
        self,
        controller: Controller,
        goal_checker: GoalChecker,
        progress_checker: ProgressChecker,
        failure_tolerance: float = 0.3,
        path_handler: PathHandler | None = None,
    ) -> None:
        self.controller = controller
        self.goal_checker = goal_checker
        self.progress_checker = progress_checker
        self.failure_tolerance = failure_tolerance
        self.path_handler = path_handler
        self._handler = PlanAhead()
        if path_handler is not None:
            self._handler = PlanAhead(
                path_handler.search_distance,
                has_cusps=not path_handler.sees_past_cusps,
                rotation_angle=path_handler.rotation_angle,
            )
        self._last_success: float | None = None

    def start(self, path: Array) -> None:
        """Start to follow a path (n, 3).

        Raises
        ------
        InvalidPath
            It is empty or not finite.
        """
        self._set_plan(path)
        self.controller.reset()
        self.goal_checker.reset()
        self.progress_checker.reset()
        self._last_success = None

    def replan(self, path: Array, *, new_goal: bool = False) -> None:
        """Continue on another path.

        Parameters
        ----------
        path : ndarray, shape (n, 3)
            Poses (x, y, yaw).
        new_goal : bool
            Whether it leads elsewhere, so that being at the last goal counts no more.

        Raises
        ------
        InvalidPath
            It is empty or not finite; the robot follows the last one.
        """
        self._set_plan(path)
        if new_goal:
            self.goal_checker.reset()
            self.progress_checker.reset()
            self.controller.reset()

    def _set_plan(self, path: Array) -> None:
        if self.path_handler is not None:
            self.path_handler.check(path)
        self._handler.set_plan(path)

    def _ahead(self, pose: Array, plan_frame: Array) -> tuple[Array, Array, float]:
        """Return the path that the controller sees, the goal, and the length of all that is left."""
        chosen = self.path_handler
        if chosen is not None:
            return self._handler.ahead(pose, plan_frame, chosen.look_ahead, chosen.tolerances)
        controller = self.controller
        return self._handler.ahead(pose, plan_frame, controller.look_ahead, controller.inversion_tolerances)

    def step(
        self,
        pose: Array,
        velocity: Array,
        costmap: Costmap,
        now: float,
        *,
        plan_frame: Array = SAME_FRAME,
        circumscribed_cost: int = 1,
    ) -> FollowPathStep:
        """Compute the velocity of the next cycle.

        Parameters
        ----------
        pose, velocity : ndarray, shape (3,)
            Pose of the robot in the costmap's frame and its velocity in its own.
        costmap : Costmap
            Inflated costs around the robot.
        now : float
            Time [s].
        plan_frame : ndarray, shape (3,)
            Pose of the path's frame in the costmap's frame (the `map` in `odom`).
        circumscribed_cost : int
            See `ControlInput`.

        Raises
        ------
        ControllerError
            The task failed: `FailedToMakeProgress`, `PatienceExceeded` or what the controller raised.
        """
        if not self._handler.has_plan:
            raise InvalidPath("there is no path to follow")
        path, goal, distance = self._ahead(pose, plan_frame)
        if self.goal_checker.is_goal_reached(pose, goal, velocity):
            return FollowPathStep(np.zeros(3), True, distance, path)
        if not self.progress_checker.check(pose, now):
            raise FailedToMakeProgress(f"the robot is stuck, {distance:.2f} m before the end of its path")
        xy_tolerance, yaw_tolerance = self.goal_checker.tolerances
        control = ControlInput(
            pose, velocity, path, goal, distance, costmap, circumscribed_cost, xy_tolerance, yaw_tolerance
        )
        try:
            command = self.controller.compute_velocity_commands(control)
        except NoValidControl as error:
            self._check_failure_tolerance(error, now)
            return FollowPathStep(np.zeros(3), False, distance, path, str(error))
        self._last_success = now
        return FollowPathStep(command, False, distance, path)

    def _check_failure_tolerance(self, error: ControllerError, now: float) -> None:
        """Raise an error if the controller has failed for longer than the tolerance."""
        if self.failure_tolerance == 0.0:
            raise error
        if self._last_success is None:
            self._last_success = now
        if 0.0 < self.failure_tolerance < now - self._last_success:
            raise PatienceExceeded(f"no valid motion for {self.failure_tolerance:.1f} s: {error}") from error
