"""What pursuit controllers share: look-ahead, turns on the spot, slowing down, and the check of the arc ahead."""

import math
from abc import abstractmethod
from dataclasses import dataclass
from typing import Any

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.common.pose2 import between
from daidalos.navigation.contracts import ControlInput, Controller, NavigationContext
from daidalos.navigation.controllers.look_ahead import look_ahead_point
from daidalos.navigation.controllers.rotation import rotation_speed
from daidalos.navigation.costmap.costmap import INSCRIBED_INFLATED_OBSTACLE, MAX_NON_OBSTACLE, NO_INFORMATION
from daidalos.navigation.costmap.footprint import FootprintCollisionChecker
from daidalos.navigation.errors import NoValidControl

_CUSP_TOLERANCES = (0.1, 0.4)
"""Distance [m] and angle [rad] at which the robot has reached a cusp of the path, and reverses."""


@dataclass(frozen=True)
class PursuitParameters(Parameters):
    """Parameters of all pursuit controllers, by their Nav2 names."""

    desired_linear_vel: float = parameter(0.5, "Speed where nothing slows the robot down.", unit="m/s", above=0.0)
    max_linear_accel: float = parameter(2.5, "Largest acceleration.", unit="m/s^2", above=0.0)
    lookahead_dist: float = parameter(0.6, "Distance of the point that is driven to.", unit="m", above=0.0)
    min_lookahead_dist: float = parameter(0.3, "Least distance, where it depends on speed.", unit="m", above=0.0)
    max_lookahead_dist: float = parameter(0.9, "Largest distance, where it depends on speed.", unit="m", above=0.0)
    lookahead_time: float = parameter(1.5, "Distance by speed.", unit="s", above=0.0)
    use_velocity_scaled_lookahead_dist: bool = parameter(True, "Whether the distance depends on speed.")
    min_approach_linear_velocity: float = parameter(0.05, "Least speed on the approach.", unit="m/s", minimum=0.0)
    approach_velocity_scaling_dist: float = parameter(
        0.6, "Distance to the goal at which the robot starts to slow down.", unit="m", minimum=0.0
    )
    use_collision_detection: bool = parameter(True, "Whether the arc ahead is checked for collisions.")
    use_cost_regulated_linear_velocity_scaling: bool = parameter(True, "Whether obstacles near by slow the robot down.")
    cost_scaling_dist: float = parameter(
        0.6, "Distance of obstacles below which the robot slows down.", unit="m", minimum=0.0
    )
    cost_scaling_gain: float = parameter(1.0, "Factor of the speed near obstacles.", above=0.0, maximum=1.0)
    inflation_cost_scaling_factor: float = parameter(
        3.0, "The inflation layer's cost_scaling_factor, to compute distances from costs.", unit="1/m", above=0.0
    )
    allow_reversing: bool = parameter(
        False, "Whether parts of the path that lie behind the robot are driven backwards, cusp by cusp."
    )
    use_rotate_to_heading: bool = parameter(True, "Whether to turn on the spot towards the path and the goal.")
    rotate_to_heading_min_angle: float = parameter(
        0.785, "Angle to the path above which the robot turns on the spot.", unit="rad", minimum=0.0
    )
    rotate_to_heading_angular_vel: float = parameter(1.8, "Turn rate on the spot.", unit="rad/s", above=0.0)
    max_angular_accel: float = parameter(3.2, "Largest turn acceleration on the spot.", unit="rad/s^2", above=0.0)


class PursuitController(Controller):
    """Base of controllers that drive on arcs to a point of the path, the carrot."""

    parameters: PursuitParameters

    def __init__(self, parameters: Any = None, context: NavigationContext | None = None) -> None:
        super().__init__(parameters, context)
        self.period = 1.0 / self.context.frequency
        self._speed_limit = self.parameters.desired_linear_vel
        self._at_goal = False
        self._rotating = False
        self._warn_of_contradictions()

    def _warn_of_contradictions(self) -> None:
        if self.parameters.allow_reversing and self.parameters.use_rotate_to_heading:
            name = self.context.name
            self.context.warn(f"{name}: allow_reversing has no effect together with use_rotate_to_heading")

    @property
    def _may_reverse(self) -> bool:
        """Whether the robot drives backwards to what is behind it."""
        return self.parameters.allow_reversing and not self.parameters.use_rotate_to_heading

    @property
    @abstractmethod
    def _collision_horizon(self) -> float:
        """How far ahead [s] collisions are looked for."""

    @abstractmethod
    def _curvature(self, path: Array, carrot: Array, index: int) -> float:
        """Return the curvature [1/m] of the arc to drive on.

        Parameters
        ----------
        path : ndarray, shape (n, 3)
            In the robot's frame.
        carrot : ndarray, shape (2,)
            Point of the path [m].
        index : int
            Of the next pose of the path.
        """

    @abstractmethod
    def _free_speed(self, curvature: float) -> float:
        """Return the speed [m/s] on an arc of a curvature [1/m] without obstacles."""

    @property
    def _least_speed(self) -> float:
        """Speed [m/s] below which obstacles and curves do not slow down."""
        return 0.0

    def reconfigure(self, parameters: Any) -> None:
        """Implement `NavigationExtension.reconfigure`; lifts the speed limit."""
        super().reconfigure(parameters)
        self._warn_of_contradictions()
        self._speed_limit = parameters.desired_linear_vel

    @property
    def look_ahead(self) -> float:
        """Implement `Controller.look_ahead`."""
        return max(self.parameters.max_lookahead_dist, self.parameters.lookahead_dist) + 0.5

    @property
    def inversion_tolerances(self) -> tuple[float, float] | None:
        """Implement `Controller.inversion_tolerances`."""
        return _CUSP_TOLERANCES if self._may_reverse else None

    def compute_velocity_commands(self, control: ControlInput) -> Array:
        """Implement `Controller.compute_velocity_commands`."""
        to_goal = between(control.pose, control.goal)
        if math.hypot(float(to_goal[0]), float(to_goal[1])) <= 0.5 * control.xy_goal_tolerance:
            self._at_goal = True
        if self._at_goal and self.parameters.use_rotate_to_heading:
            return self._turn(control, float(to_goal[2]))
        path = between(control.pose, control.path)
        carrot, index = look_ahead_point(path[:, :2], self._carrot_distance(control))
        angle = math.atan2(float(carrot[1]), float(carrot[0]))
        if self._must_rotate(angle):
            return self._turn(control, angle)
        curvature = self._curvature(path, carrot, index)
        direction = -1.0 if self._may_reverse and carrot[0] < 0.0 else 1.0
        speed = self._regulated_speed(control, curvature, direction)
        turn = speed * curvature
        if self.parameters.use_collision_detection:
            self._refuse_collision(control, speed, turn, math.hypot(float(carrot[0]), float(carrot[1])))
        return np.array([speed, 0.0, turn])

    def set_speed_limit(self, speed_limit: float, *, percentage: bool) -> None:
        """Implement `Controller.set_speed_limit`."""
        most = self.parameters.desired_linear_vel
        limit = most * speed_limit / 100.0 if percentage else speed_limit
        self._speed_limit = most if speed_limit <= 0.0 else min(limit, most)

    def reset(self) -> None:
        """Implement `Controller.reset`."""
        self._at_goal = False
        self._rotating = False

    def _carrot_distance(self, control: ControlInput) -> float:
        """Return the look-ahead distance [m]."""
        p = self.parameters
        if not p.use_velocity_scaled_lookahead_dist:
            return p.lookahead_dist
        scaled = abs(float(control.velocity[0])) * p.lookahead_time
        return min(max(scaled, p.min_lookahead_dist), p.max_lookahead_dist)

    def _must_rotate(self, angle: float) -> bool:
        """Return whether to rotate in place; once started, until the carrot is nearly ahead."""
        if not self.parameters.use_rotate_to_heading:
            return False
        enough = 0.15 if self._rotating else self.parameters.rotate_to_heading_min_angle
        self._rotating = abs(angle) > enough
        return self._rotating

    def _turn(self, control: ControlInput, angle: float) -> Array:
        """Return the velocity to rotate in place, after the robot has stopped."""
        p = self.parameters
        forward = float(control.velocity[0])
        slower = math.copysign(max(abs(forward) - p.max_linear_accel * self.period, 0.0), forward)
        turn = rotation_speed(
            angle,
            float(control.velocity[2]),
            max_speed=p.rotate_to_heading_angular_vel,
            max_accel=p.max_angular_accel,
            period=self.period,
        )
        return np.array([slower if abs(slower) > 0.02 else 0.0, 0.0, turn])

    def _regulated_speed(self, control: ControlInput, curvature: float, direction: float) -> float:
        """Return the velocity ahead [m/s], negative where the direction is -1."""
        p = self.parameters
        speed = min(self._free_speed(curvature), self._speed_limit)
        if p.use_cost_regulated_linear_velocity_scaling:
            speed *= self._proximity_scale(control)
        speed = max(speed, min(self._least_speed, self._speed_limit))
        speed = min(speed, p.rotate_to_heading_angular_vel / max(abs(curvature), 1e-6))
        remaining = control.distance_to_goal
        if remaining < p.approach_velocity_scaling_dist:
            approach = self._speed_limit * remaining / p.approach_velocity_scaling_dist
            speed = min(speed, max(approach, p.min_approach_linear_velocity))
        step = p.max_linear_accel * self.period
        present = float(control.velocity[0])
        return min(max(direction * speed, present - step), present + step)

    def _proximity_scale(self, control: ControlInput) -> float:
        """Return the ratio of the speed that the nearest obstacle allows, by its distance from the inflated cost."""
        p = self.parameters
        cost = control.costmap.cost_at(float(control.pose[0]), float(control.pose[1]))
        if cost in (0, NO_INFORMATION):
            return 1.0
        inscribed = self.context.footprint.inscribed_radius
        cost = min(cost, INSCRIBED_INFLATED_OBSTACLE)
        away = inscribed - math.log(cost / MAX_NON_OBSTACLE) / p.inflation_cost_scaling_factor
        if away >= p.cost_scaling_dist:
            return 1.0
        return max(p.cost_scaling_gain * away / p.cost_scaling_dist, 0.0)

    def _refuse_collision(self, control: ControlInput, speed: float, turn: float, reach: float) -> None:
        """Raise an error if the arc collides before the carrot or the maximum time."""
        checker = FootprintCollisionChecker(control.costmap, self.context.footprint)
        if checker.in_collision(control.pose):
            return
        step = control.costmap.resolution / max(abs(speed), 0.05)
        pose = control.pose.copy()
        elapsed = 0.0
        while elapsed < self._collision_horizon:
            elapsed += step
            heading = pose[2] + 0.5 * turn * step
            pose = pose + step * np.array([speed * math.cos(heading), speed * math.sin(heading), turn])
            if math.hypot(float(pose[0] - control.pose[0]), float(pose[1] - control.pose[1])) > reach:
                return
            if checker.in_collision(pose):
                raise NoValidControl(
                    f"an obstacle is in the way at ({float(pose[0]):.2f}, {float(pose[1]):.2f}), {elapsed:.1f} s ahead"
                )
