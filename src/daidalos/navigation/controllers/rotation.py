"""Rotation in place to a heading without overshoot."""

import math


def rotation_speed(angle: float, speed: float, *, max_speed: float, max_accel: float, period: float) -> float:
    """Return the angular velocity of the next cycle of a rotation that ends at rest.

    Parameters
    ----------
    angle : float
        How far [rad] is left to turn, positive to the left.
    speed : float
        Present angular velocity [rad/s].
    max_speed : float
        Fastest turn [rad/s].
    max_accel : float
        Largest change of the angular velocity [rad/s^2].
    period : float
        Length of a cycle [s].

    Returns
    -------
    float
        Angular velocity [rad/s]: as fast as allowed, but never so fast that braking at the largest
        deceleration, begun one cycle later, would overshoot.
    """
    step = max_accel * period
    remaining = abs(angle)
    braking = max(math.sqrt(2.0 * max_accel * remaining + 0.25 * step * step) - 0.5 * step, 0.0)
    wanted = math.copysign(min(max_speed, braking, remaining / period), angle)
    return min(max(wanted, speed - step), speed + step)
