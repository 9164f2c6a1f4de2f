"""Regulated pure pursuit: arcs to a carrot point, slower in tight curves and near obstacles."""

from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import parameter
from daidalos.navigation.controllers.look_ahead import look_ahead_point
from daidalos.navigation.controllers.pursuit import PursuitController, PursuitParameters


@dataclass(frozen=True)
class RegulatedPurePursuitParameters(PursuitParameters):
    """Parameters of the controller, by their Nav2 names."""

    max_allowed_time_to_collision_up_to_carrot: float = parameter(
        1.0, "How far ahead collisions are looked for.", unit="s", minimum=0.0
    )
    use_regulated_linear_velocity_scaling: bool = parameter(True, "Whether tight curves slow the robot down.")
    regulated_linear_scaling_min_radius: float = parameter(
        0.9, "Radius of curves below which the robot slows down.", unit="m", above=0.0
    )
    regulated_linear_scaling_min_speed: float = parameter(
        0.15, "Least speed that curves and obstacles slow down to.", unit="m/s", minimum=0.0
    )
    use_fixed_curvature_lookahead: bool = parameter(
        False, "Whether the curvature is that of the point at curvature_lookahead_dist."
    )
    curvature_lookahead_dist: float = parameter(0.6, "Distance of the point of the curvature.", unit="m", above=0.0)
    interpolate_curvature_after_goal: bool = parameter(
        False, "Whether the path goes on straight beyond the goal for the point of the curvature."
    )


class RegulatedPurePursuitController(PursuitController):
    """Pure pursuit with a regulated speed.

    After Macenski et al. 2023, "Regulated Pure Pursuit for Robot Path Tracking". The carrot is the point of
    the path at the look-ahead distance. The arc that leaves the robot along its heading and meets the carrot
    has the curvature `2 y / (x^2 + y^2)`. The speed is reduced on tight arcs, near obstacles and towards the
    goal; a carrot far to the side, and the yaw of the goal, are reached by a turn on the spot.
    """

    names = ("nav2_regulated_pure_pursuit_controller::RegulatedPurePursuitController",)
    Parameters = RegulatedPurePursuitParameters
    parameters: RegulatedPurePursuitParameters

    def _warn_of_contradictions(self) -> None:
        super()._warn_of_contradictions()
        p = self.parameters
        if p.interpolate_curvature_after_goal and not p.use_fixed_curvature_lookahead:
            name = self.context.name
            self.context.warn(f"{name}: interpolate_curvature_after_goal needs use_fixed_curvature_lookahead")

    @property
    def look_ahead(self) -> float:
        """Implement `Controller.look_ahead`."""
        return max(super().look_ahead, self.parameters.curvature_lookahead_dist + 0.5)

    @property
    def _collision_horizon(self) -> float:
        return self.parameters.max_allowed_time_to_collision_up_to_carrot

    @property
    def _least_speed(self) -> float:
        return self.parameters.regulated_linear_scaling_min_speed

    def _free_speed(self, curvature: float) -> float:
        p = self.parameters
        radius = 1.0 / max(abs(curvature), 1e-6)
        if p.use_regulated_linear_velocity_scaling and radius < p.regulated_linear_scaling_min_radius:
            return self._speed_limit * radius / p.regulated_linear_scaling_min_radius
        return self._speed_limit

    def _curvature(self, path: Array, carrot: Array, index: int) -> float:
        p = self.parameters
        points = path[:, :2]
        if p.use_fixed_curvature_lookahead:
            if p.interpolate_curvature_after_goal and points.shape[0] > 1:
                step = points[-1] - points[-2]
                length = max(float(np.hypot(*step)), 1e-6)
                beyond = points[-1] + p.curvature_lookahead_dist * 2.0 / length * step
                points = np.concatenate([points, beyond[None]])
            carrot = look_ahead_point(points, p.curvature_lookahead_dist)[0]
        squared = float(carrot[0] ** 2 + carrot[1] ** 2)
        return 2.0 * float(carrot[1]) / squared if squared > 1e-6 else 0.0
