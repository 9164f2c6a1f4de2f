"""Arithmetic with angles in radians."""

from __future__ import annotations

from math import fmod, pi

_TURN = 2.0 * pi


def normalize_angle_positive(angle: float) -> float:
    """Return the angle from 0 up to 2 pi that points in the same direction."""
    return fmod(fmod(angle, _TURN) + _TURN, _TURN)


def normalize_angle(angle: float) -> float:
    """Return the angle from -pi to pi that points in the same direction."""
    positive = normalize_angle_positive(angle)
    return positive - _TURN if positive > pi else positive


def shortest_angular_distance(from_angle: float, to_angle: float) -> float:
    """Return the shortest turn, from -pi to pi, that leads from one angle to another."""
    return normalize_angle(to_angle - from_angle)


def two_pi_complement(angle: float) -> float:
    """Return the turn that leads to the same direction the other way round."""
    if abs(angle) > _TURN:
        angle = fmod(angle, _TURN)
    return angle - _TURN if angle > 0.0 else angle + _TURN


def shortest_angular_distance_with_limits(
    from_angle: float, to_angle: float, left_limit: float, right_limit: float
) -> tuple[bool, float]:
    """Return the shortest turn from one angle to another that stays between limits.

    Parameters
    ----------
    from_angle, to_angle
        Directions.
    left_limit, right_limit
        From -pi to pi. Allowed is what lies counterclockwise of the left limit up to the right one, so that
        ``(-0.25, 0.25)`` allows zero and ``(0.25, -0.25)`` does not.

    Returns
    -------
    (bool, float)
        Whether both angles are allowed, and the turn. Where they are not, it is the one that approaches, or
        leaves, the forbidden angles over the nearer limit.
    """
    allowed, clockwise, counterclockwise = _allowed_rotation(from_angle, left_limit, right_limit)
    turn = shortest_angular_distance(from_angle, to_angle)
    other = two_pi_complement(turn)
    if not allowed:
        return False, _toward(turn, other, -clockwise, counterclockwise)
    for one in (turn, other):
        if clockwise <= one <= counterclockwise:
            return True, one
    _, to_right, to_left = _allowed_rotation(to_angle, left_limit, right_limit)
    return False, _toward(turn, other, to_left, -to_right)


def shortest_angular_distance_with_large_limits(
    from_angle: float, to_angle: float, left_limit: float, right_limit: float
) -> tuple[bool, float]:
    """Return the shortest turn from an angle to a direction that stays between limits beyond a full turn.

    Parameters
    ----------
    from_angle
        Between the limits.
    to_angle
        A direction: any multiple of a full turn may be added to it.
    left_limit, right_limit
        The least and the largest angle allowed.

    Returns
    -------
    (bool, float)
        Whether the turn begins and ends between the limits, and the turn.
    """
    turn = shortest_angular_distance(from_angle, to_angle)
    if left_limit > right_limit:
        return False, turn
    for one in sorted((turn, two_pi_complement(turn)), key=abs):
        if left_limit <= from_angle + one <= right_limit:
            return left_limit <= from_angle <= right_limit, one
    return False, turn


def _allowed_rotation(angle: float, left_limit: float, right_limit: float) -> tuple[bool, float, float]:
    """Return whether an angle is allowed, and how far it may turn, clockwise (negative) and counterclockwise.

    For an angle that is not allowed, that is how far it is to the right limit and to the left one.
    """
    to_left = shortest_angular_distance(angle, left_limit)
    to_right = shortest_angular_distance(angle, right_limit)
    left_clockwise, left_counterclockwise = sorted((to_left, two_pi_complement(to_left)))
    right_clockwise, right_counterclockwise = sorted((to_right, two_pi_complement(to_right)))
    if to_left == 0.0:
        return True, 0.0, right_counterclockwise
    if to_right == 0.0:
        return True, left_clockwise, 0.0
    if left_clockwise <= right_clockwise or right_counterclockwise >= left_counterclockwise:
        everything = left_limit == -pi and right_limit == pi
        return everything, right_clockwise, left_counterclockwise
    return True, left_clockwise, right_counterclockwise


def _toward(turn: float, other: float, clockwise: float, counterclockwise: float) -> float:
    """Return the turn in the direction in which a limit is nearer, the shorter one when both are equally near."""
    if clockwise < counterclockwise:
        return min(turn, other)
    if clockwise > counterclockwise:
        return max(turn, other)
    return min(turn, other, key=abs)
