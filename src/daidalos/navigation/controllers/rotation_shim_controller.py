"""Controller that rotates to the path, follows it by another controller, and rotates to the goal's yaw."""

import math
from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.common.pose2 import between
from daidalos.navigation.contracts import ControlInput, Controller, NavigationContext, Output
from daidalos.navigation.controllers.rotation import rotation_speed
from daidalos.navigation.costmap.footprint import FootprintCollisionChecker
from daidalos.navigation.extensions import CONTROLLERS
from daidalos.navigation.paths import distances_along


@dataclass(frozen=True)
class RotationShimParameters(Parameters):
    """Parameters of the controller, by their Nav2 names."""

    angular_dist_threshold: float = parameter(
        0.785, "Angle to the path above which the robot turns on the spot.", unit="rad", minimum=0.0
    )
    angular_disengage_threshold: float = parameter(
        0.3, "Angle to the path below which the primary controller takes over.", unit="rad", minimum=0.0
    )
    forward_sampling_distance: float = parameter(
        0.5, "Distance of the path point that the robot turns to.", unit="m", above=0.0
    )
    rotate_to_heading_angular_vel: float = parameter(1.8, "Turn rate on the spot.", unit="rad/s", above=0.0)
    max_angular_accel: float = parameter(3.2, "Largest turn acceleration.", unit="rad/s^2", above=0.0)
    simulate_ahead_time: float = parameter(
        1.0, "How far ahead the turn is checked for collisions.", unit="s", minimum=0.0
    )
    rotate_to_goal_heading: bool = parameter(True, "Whether to turn on the spot at the goal.")
    primary_controller: str = parameter(
        "nav2_regulated_pure_pursuit_controller::RegulatedPurePursuitController",
        "Controller that drives; its parameters stand beside these.",
        read_only=True,
    )


class RotationShimController(Controller):
    """Wrapper of a controller that adds rotation in place at the start and at the end.

    A robot whose path leads sideways or back turns on the spot where it has room to. Within the goal's
    tolerance it turns to the goal's yaw; the braking curve of `rotation_speed` ends the turn without
    overshoot.

    Parameters
    ----------
    parameters : RotationShimParameters, optional
        When and how fast to turn.
    context : NavigationContext, optional
    primary : Controller, optional
        The controller that drives; the parameter `primary_controller` names it where it is left out.
    """

    names = ("nav2_rotation_shim_controller::RotationShimController",)
    Parameters = RotationShimParameters
    parameters: RotationShimParameters

    def __init__(
        self,
        parameters: RotationShimParameters | None = None,
        context: NavigationContext | None = None,
        primary: Controller | None = None,
    ) -> None:
        super().__init__(parameters, context)
        self.primary = primary or self.context.make(
            CONTROLLERS, self.parameters.primary_controller, "primary_controller"
        )
        self.period = 1.0 / self.context.frequency
        self._starting = True
        self._turning = False
        self._at_goal = False

    @property
    def look_ahead(self) -> float:
        """Implement `Controller.look_ahead`."""
        return max(self.primary.look_ahead, self.parameters.forward_sampling_distance)

    @property
    def inversion_tolerances(self) -> tuple[float, float] | None:
        """Implement `Controller.inversion_tolerances` by the primary controller's."""
        return self.primary.inversion_tolerances

    @property
    def outputs(self) -> tuple[Output, ...]:
        """Implement `Controller.outputs` by the primary controller's."""
        return self.primary.outputs

    def compute_velocity_commands(self, control: ControlInput) -> Array:
        """Implement `Controller.compute_velocity_commands`."""
        to_goal = between(control.pose, control.goal)
        away = math.hypot(float(to_goal[0]), float(to_goal[1]))
        if self.parameters.rotate_to_goal_heading and (self._at_goal or away <= 0.8 * control.xy_goal_tolerance):
            self._at_goal = True
            return self._turn(control, float(to_goal[2]))
        if self._starting or control.distance_to_goal < 0.3:
            angle = self._angle_to_path(control)
            self._starting = self._must_turn(control, angle)
            if self._starting:
                self._turning = True
                return self._turn(control, angle)
        return self.primary.compute_velocity_commands(control)

    def set_speed_limit(self, speed_limit: float, *, percentage: bool) -> None:
        """Implement `Controller.set_speed_limit`."""
        self.primary.set_speed_limit(speed_limit, percentage=percentage)

    def reset(self) -> None:
        """Implement `Controller.reset`."""
        self._starting = True
        self._turning = False
        self._at_goal = False
        self.primary.reset()

    def _angle_to_path(self, control: ControlInput) -> float:
        """Return the bearing [rad] of the path at the sampling distance, or of its end."""
        along = distances_along(control.path)
        index = min(int(np.searchsorted(along, self.parameters.forward_sampling_distance)), along.size - 1)
        ahead = between(control.pose, control.path[index])
        return math.atan2(float(ahead[1]), float(ahead[0]))

    def _turn(self, control: ControlInput, angle: float) -> Array:
        p = self.parameters
        turn = rotation_speed(
            angle,
            float(control.velocity[2]),
            max_speed=p.rotate_to_heading_angular_vel,
            max_accel=p.max_angular_accel,
            period=self.period,
        )
        return np.array([0.0, 0.0, turn])

    def _must_turn(self, control: ControlInput, angle: float) -> bool:
        """Return whether the robot faces away from the path and can rotate; once started, until it faces it."""
        p = self.parameters
        enough = p.angular_disengage_threshold if self._turning else p.angular_dist_threshold
        return abs(angle) > enough and self._can_turn(control, angle)

    def _can_turn(self, control: ControlInput, angle: float) -> bool:
        """Return whether the simulated rotation touches nothing that the robot does not touch now."""
        if self.context.footprint.circular:
            return True
        p = self.parameters
        checker = FootprintCollisionChecker(control.costmap, self.context.footprint)
        end = math.copysign(min(abs(angle), p.rotate_to_heading_angular_vel * p.simulate_ahead_time), angle)
        turns = np.linspace(0.0, end, max(int(abs(end) / 0.1), 2))
        return not any(checker.in_collision(control.pose + np.array([0.0, 0.0, turn])) for turn in turns)
