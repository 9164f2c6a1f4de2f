"""Smooth control law in egocentric polar coordinates: drives a pose to a target pose on a curve without a stop.

Jong Jin Park and Benjamin Kuipers, "A Smooth Control Law for Graceful Motion of Differential Wheeled Mobile Robots in
2D Environment", ICRA 2011.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from daidalos.common.arrays import Array
from daidalos.common.pose2 import move_along_arc, wrap


@dataclass(frozen=True)
class EgoPolarLaw:
    """Control law with its gains and limits, by the names of Nav2's parameters.

    Attributes
    ----------
    k_phi : float
        Ratio of the rates at which the heading of the target and the distance vanish; 0 ignores the heading.
    k_delta : float
        How fast the robot turns to the curve.
    beta, lambda_ : float
        How much the speed falls with the curvature: it is divided by ``1 + beta * |curvature|**lambda``.
    slowdown_radius : float
        Distance [m] from the target within which the speed falls in proportion to it.
    v_linear_min, v_linear_max : float
        Bounds of the speed [m/s].
    v_angular_max : float
        Bound of the turn rate [rad/s]; the speed falls with it, so that the curve stays the same.
    deceleration_max : float
        Deceleration [m/s^2] by which the robot can stop at the target; bounds the speed on the way to it.
    """

    k_phi: float
    k_delta: float
    beta: float
    lambda_: float
    slowdown_radius: float
    v_linear_min: float
    v_linear_max: float
    v_angular_max: float
    deceleration_max: float = math.inf

    def curvature(self, pose: Array, target: Array, *, backward: bool = False) -> float:
        """Return the curvature [1/m] of the path from a pose (x, y, yaw), as driven ahead; 0 at the target itself.

        Parameters
        ----------
        pose, target : ndarray, shape (3,)
            In one frame.
        backward : bool
            Whether the robot drives backwards; a positive curvature then turns it to the right.
        """
        r, phi, delta = egocentric_coordinates(pose, target, backward=backward)
        if r < 1e-6:
            return 0.0
        slow = delta + math.atan(self.k_phi * phi)
        feedback = (1.0 + self.k_phi / (1.0 + (self.k_phi * phi) ** 2)) * math.sin(delta)
        return -(self.k_delta * slow + feedback) / r

    def velocity(self, pose: Array, target: Array, *, backward: bool = False) -> tuple[float, float]:
        """Return the speed [m/s], negative backwards, and the turn rate [rad/s] at a pose; see `curvature`."""
        curvature = self.curvature(pose, target, backward=backward)
        distance = math.hypot(target[0] - pose[0], target[1] - pose[1])
        speed = self.v_linear_max / (1.0 + self.beta * abs(curvature) ** self.lambda_)
        if self.slowdown_radius > 0.0:
            speed = min(speed, self.v_linear_max * distance / self.slowdown_radius)
        speed = min(speed, math.sqrt(2.0 * distance * self.deceleration_max))
        speed = min(max(speed, self.v_linear_min), self.v_linear_max)
        turn = min(max(curvature * speed, -self.v_angular_max), self.v_angular_max)
        if curvature:
            speed = turn / curvature
        return (-speed if backward else speed), turn

    def next_pose(self, pose: Array, target: Array, step: float, *, backward: bool = False) -> Array:
        """Return the pose (x, y, yaw) after a step [s] at the velocity of a pose."""
        speed, turn = self.velocity(pose, target, backward=backward)
        return move_along_arc(pose, speed * step, turn * step)


def egocentric_coordinates(pose: Array, target: Array, *, backward: bool = False) -> tuple[float, float, float]:
    """Return distance [m], and the headings [rad] of target and robot from the line of sight between them.

    Parameters
    ----------
    pose, target : ndarray, shape (3,)
        Poses (x, y, yaw) in one frame.
    backward : bool
        Whether the robot looks along the line of sight with its back.
    """
    dx, dy = float(target[0] - pose[0]), float(target[1] - pose[1])
    sight = math.atan2(dy, dx) + (math.pi if backward else 0.0)
    return math.hypot(dx, dy), float(wrap(target[2] - sight)), float(wrap(pose[2] - sight))
