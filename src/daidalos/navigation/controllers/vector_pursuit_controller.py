"""Vector pursuit: arcs that lead to a point of the path and to the direction of the path there."""

import math
from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import parameter
from daidalos.common.pose2 import wrap
from daidalos.navigation.controllers.pursuit import PursuitController, PursuitParameters

_LEAST_TURN = 1e-6
"""Turn of an arc [rad] below which it is a straight line."""


@dataclass(frozen=True)
class VectorPursuitParameters(PursuitParameters):
    """Parameters of the controller, by the names of vector_pursuit_controller."""

    k: float = parameter(8.0, "How many times as long the turn takes as the way.", above=0.0)
    min_turning_radius: float = parameter(1.0, "Least radius of a curve.", unit="m", above=0.0)
    min_linear_velocity: float = parameter(
        0.05, "Least speed that curves and obstacles slow down to.", unit="m/s", minimum=0.0
    )
    max_linear_accel: float = parameter(2.0, "Largest acceleration.", unit="m/s^2", above=0.0)
    max_lateral_accel: float = parameter(
        0.5, "Largest acceleration to the side, by which curves slow the robot down.", unit="m/s^2", above=0.0
    )
    approach_velocity_scaling_dist: float = parameter(
        1.0, "Distance to the goal at which the robot starts to slow down.", unit="m", minimum=0.0
    )
    max_allowed_time_to_collision_up_to_target: float = parameter(
        1.0, "How far ahead collisions are looked for.", unit="s", minimum=0.0
    )
    use_interpolation: bool = parameter(
        True, "Whether the point is exactly at the look-ahead distance, rather than the next pose of the path."
    )
    use_heading_from_path: bool = parameter(
        False, "Whether the direction is that of the path's poses, rather than that from one to the next."
    )


class VectorPursuitController(PursuitController):
    """Vector pursuit (Wit, "Vector pursuit path tracking for autonomous ground vehicles", University of Florida 2000).

    The motion to the carrot is a screw that adds up two: the arc of pure pursuit, which reaches the point and turns the
    robot by an angle `phi`, and the turn by what is missing then to the direction `theta` of the path there. With turns
    that take `k` times as long as ways, the curvature is that of pure pursuit times `((k - 1) phi + theta) / (k phi)`.
    """

    names = ("vector_pursuit_controller::VectorPursuitController",)
    Parameters = VectorPursuitParameters
    parameters: VectorPursuitParameters

    @property
    def _collision_horizon(self) -> float:
        return self.parameters.max_allowed_time_to_collision_up_to_target

    @property
    def _least_speed(self) -> float:
        return self.parameters.min_linear_velocity

    def _free_speed(self, curvature: float) -> float:
        return math.sqrt(self.parameters.max_lateral_accel / max(abs(curvature), 1e-6))

    def _curvature(self, path: Array, carrot: Array, index: int) -> float:
        p = self.parameters
        if not p.use_interpolation:
            carrot = path[index, :2]
        x, y = float(carrot[0]), float(carrot[1])
        most = 1.0 / p.min_turning_radius
        if x < 0.0 and not self._may_reverse:
            return math.copysign(most, y)
        phi = 2.0 * math.atan2(y, abs(x))  # of the arc that leaves along x, to the left on the way ahead
        squared = x * x + y * y
        if abs(phi) < _LEAST_TURN or squared < 1e-6:
            return 0.0
        theta = self._heading(path, index, reverses=x < 0.0) * (1.0 if x >= 0.0 else -1.0)
        share = ((p.k - 1.0) * phi + theta) / (p.k * phi)
        return float(np.clip(share * 2.0 * y / squared, -most, most))

    def _heading(self, path: Array, index: int, *, reverses: bool) -> float:
        """Return how [rad] the robot looks where it follows the path at its point before a pose, in its own frame."""
        if self.parameters.use_heading_from_path or path.shape[0] < 2:
            return float(wrap(path[index, 2]))
        step = path[max(index, 1), :2] - path[max(index, 1) - 1, :2]
        return float(wrap(math.atan2(float(step[1]), float(step[0])) + (math.pi if reverses else 0.0)))
