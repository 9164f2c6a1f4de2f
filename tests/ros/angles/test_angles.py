"""Angles, against sines and cosines and against plain searching."""

from math import cos, pi, sin, tau

import angles
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

any_angle = st.floats(-50.0, 50.0)
directions = st.floats(-3.1, 3.1)


def same_direction(one: float, two: float) -> bool:
    return abs(sin(one) - sin(two)) < 1e-9 and abs(cos(one) - cos(two)) < 1e-9


@given(any_angle)
def test_normalizing(angle: float) -> None:
    positive, around_zero = angles.normalize_angle_positive(angle), angles.normalize_angle(angle)
    assert 0.0 <= positive < tau
    assert -pi <= around_zero <= pi
    assert same_direction(positive, angle)
    assert same_direction(around_zero, angle)


@pytest.mark.parametrize(
    ("angle", "positive", "around_zero"),
    [(0.0, 0.0, 0.0), (pi, pi, pi), (-pi, pi, pi), (tau, 0.0, 0.0), (3 * pi, pi, pi), (-pi / 2, 1.5 * pi, -pi / 2)],
)
def test_known_angles(angle: float, positive: float, around_zero: float) -> None:
    assert angles.normalize_angle_positive(angle) == pytest.approx(positive, abs=1e-12)
    assert angles.normalize_angle(angle) == pytest.approx(around_zero, abs=1e-12)


@given(any_angle, any_angle)
def test_the_shortest_turn(one: float, two: float) -> None:
    turn = angles.shortest_angular_distance(one, two)
    assert abs(turn) <= pi
    assert same_direction(one + turn, two)


@pytest.mark.parametrize(
    ("one", "two", "turn"),
    [(0.0, pi / 2, pi / 2), (pi / 2, 0.0, -pi / 2), (0.9 * pi, -0.9 * pi, 0.2 * pi), (-0.9 * pi, 0.9 * pi, -0.2 * pi)],
)
def test_known_turns(one: float, two: float, turn: float) -> None:
    assert angles.shortest_angular_distance(one, two) == pytest.approx(turn)


@pytest.mark.parametrize(
    ("turn", "other"), [(0.0, tau), (tau, 0.0), (-tau, 0.0), (1.0, 1.0 - tau), (-1.0, tau - 1.0), (7.0, 7.0 - 2 * tau)]
)
def test_the_other_way_round(turn: float, other: float) -> None:
    assert angles.two_pi_complement(turn) == pytest.approx(other)


def is_allowed(angle: float, left: float, right: float) -> bool:
    """Whether an angle lies counterclockwise between limits."""
    return (angle - left) % tau <= (right - left) % tau


def stays_allowed(begin: float, turn: float, left: float, right: float) -> bool:
    """Whether the whole way does."""
    return all(is_allowed(begin + turn * step / 500, left, right) for step in range(501))


@given(directions, directions, directions, directions)
def test_limits_as_searching_finds_them(begin: float, end: float, left: float, right: float) -> None:
    for one in (begin, end):
        for limit in (left, right):
            assume(abs(sin((one - limit) / 2)) > 1e-2)
    assume(abs(sin((left - right) / 2)) > 1e-2)
    assume(abs(sin((begin - end) / 2)) > 1e-3)
    possible, turn = angles.shortest_angular_distance_with_limits(begin, end, left, right)
    assert same_direction(begin + turn, end)
    ways = [angles.shortest_angular_distance(begin, end)]
    ways.append(angles.two_pi_complement(ways[0]))
    good = [way for way in ways if stays_allowed(begin, way, left, right)]
    assert possible is bool(good)
    if good:
        assert turn == good[0]
    else:
        assert not (is_allowed(begin, left, right) and is_allowed(end, left, right))


@pytest.mark.parametrize(
    ("begin", "end", "left", "right", "expected"),
    [
        (-0.5, 0.5, 0.25, -0.25, (True, 1.0 - tau)),
        (0.5, 0.5, 0.25, -0.25, (True, 0.0)),
        (0.5, 0.6, 0.25, -0.25, (True, 0.1)),
        (0.5, -0.5, 0.25, -0.25, (True, tau - 1.0)),
        (-0.2, 0.2, -0.25, 0.25, (True, 0.4)),
        (0.25, -0.25, 0.25, -0.25, (True, tau - 0.5)),
        (-0.25, 0.25, 0.25, -0.25, (True, 0.5 - tau)),
        (-3.0, 3.0, -pi, pi, (True, 6.0)),
        (pi, -pi, -pi, pi, (True, 0.0)),
        (-0.5, 0.5, -0.25, 0.25, (False, 1.0)),
        (0.5, 0.0, -0.25, 0.25, (False, -0.5)),
        (-0.5, 0.0, -0.25, 0.25, (False, 0.5)),
        (0.0, 0.4, -0.25, 0.25, (False, 0.4)),
        (0.0, -0.4, -0.25, 0.25, (False, -0.4)),
        (0.0, 1.0, 0.25, -0.25, (False, 1.0)),
    ],
)
def test_known_turns_between_limits(
    begin: float, end: float, left: float, right: float, expected: tuple[bool, float]
) -> None:
    possible, turn = angles.shortest_angular_distance_with_limits(begin, end, left, right)
    assert possible is expected[0]
    assert same_direction(begin + turn, end)
    if not (possible and expected[1] == 0.0):
        assert turn == pytest.approx(expected[1])


@pytest.mark.parametrize(
    ("begin", "end", "left", "right", "expected"),
    [
        (0.0, 10.5 * pi, -tau, tau, (True, 0.5 * pi)),
        (1.9 * pi, 0.2 * pi, -tau, tau, (True, -1.7 * pi)),
        (0.5 * tau + 1.0, 0.0, -tau, tau, (True, 0.5 * tau - 1.0)),
        (10.5 * pi, 0.0, -tau, tau, (False, -0.5 * pi)),
        (0.0, 3.0, -1.0, 1.0, (False, 3.0)),
        (0.0, 0.5, 1.0, -1.0, (False, 0.5)),
    ],
)
def test_large_limits(begin: float, end: float, left: float, right: float, expected: tuple[bool, float]) -> None:
    possible, turn = angles.shortest_angular_distance_with_large_limits(begin, end, left, right)
    assert possible is expected[0]
    assert turn == pytest.approx(expected[1])


@given(st.floats(-6.0, 6.0), any_angle)
def test_large_limits_are_kept(begin: float, end: float) -> None:
    possible, turn = angles.shortest_angular_distance_with_large_limits(begin, end, -tau, tau)
    assert possible
    assert -tau <= begin + turn <= tau
    assert same_direction(begin + turn, end)
