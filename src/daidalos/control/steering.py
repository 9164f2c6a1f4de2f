"""Kinematics of bases with steered wheels: bicycle, tricycle and Ackermann.

Siegwart, Nourbakhsh, Scaramuzza, *Introduction to Autonomous Mobile Robots*, 2nd edition, MIT Press 2011, chapter 3.
The base's origin is in the middle of the axle that does not steer, whose wheels are driven.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array

_STRAIGHT = 1e-9
_FREE_ANGLE = math.pi / 6


@dataclass(frozen=True)
class SteeredBase:
    """Sizes of a base.

    Parameters
    ----------
    wheelbase : float
        Between the axles [m].
    wheel_radius : float
        Of the driven wheels [m].
    traction_track : float
        Between two driven wheels [m]; 0 where there is one.
    steering_track : float
        Between two steered wheels [m]; 0 where there is one.
    """

    wheelbase: float
    wheel_radius: float
    traction_track: float = 0.0
    steering_track: float = 0.0

    @property
    def traction_count(self) -> int:
        """Number of driven wheels."""
        return 2 if self.traction_track > 0.0 else 1

    @property
    def steering_count(self) -> int:
        """Number of steered wheels."""
        return 2 if self.steering_track > 0.0 else 1

    def steering_angle(self, speed: float, turn: float) -> float | None:
        """Return the angle of a wheel in the middle of the steered axle [rad]; None where the base stands.

        Parameters
        ----------
        speed, turn : float
            Of the base [m/s, rad/s].
        """
        return math.atan(turn * self.wheelbase / speed) if abs(speed) > _STRAIGHT else None

    def wheel_speeds(self, speed: float, angle: float) -> Array:
        """Return the driven wheels' speeds, right before left [rad/s], for a steering angle."""
        middle = speed / self.wheel_radius
        if self.traction_count == 1:
            return np.array([middle])
        inner = math.tan(angle) / self.wheelbase * self.traction_track / 2
        return np.array([middle * (1 + inner), middle * (1 - inner)])

    def wheel_angles(self, angle: float) -> Array:
        """Return the steered wheels' angles, right before left [rad]; their axles meet in the centre of rotation."""
        if self.steering_count == 1:
            return np.array([angle])
        forward, half = self.wheelbase * math.sin(angle), self.steering_track / 2 * math.sin(angle)
        sideways = self.wheelbase * math.cos(angle)
        return np.array([math.atan2(forward, sideways + half), math.atan2(forward, sideways - half)])

    def motion(self, wheel_speeds: Array, wheel_angles: Array) -> tuple[float, float]:
        """Return the base's speed [m/s] and turn rate [rad/s] from its wheels, in the same orders."""
        speed = float(np.mean(wheel_speeds)) * self.wheel_radius
        slopes = np.tan(wheel_angles)
        if self.steering_count == 2:
            half = np.array([-self.steering_track / 2, self.steering_track / 2])
            curvature = float(np.mean(slopes / (self.wheelbase + half * slopes)))
        else:
            curvature = float(slopes[0]) / self.wheelbase
        return speed, speed * curvature


def speed_share(error: float) -> float:
    """Return the ratio of its speed that a base may have at a steering error [rad].

    All of it up to 30 degrees, then less, and next to nothing from 90 degrees on.
    """
    if error < _FREE_ANGLE:
        return 1.0
    return max(math.cos(error), 0.01) / math.cos(_FREE_ANGLE)
