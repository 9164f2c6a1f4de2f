"""Pan and tilt of a moving head: the DH table, both solutions, the choice between them and the movement profile."""

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from daidalos.common.pose3 import Pose
from daidalos.industry.lighting.kinematics import (
    AXIS_TOLERANCE,
    Angles,
    Geometry,
    Limits,
    PointingError,
    aim,
    off_axis_angle,
)  # fmt: skip
from daidalos.industry.lighting.motion import Motion

angles = st.floats(-math.pi, math.pi)
small = st.floats(-0.03, 0.03)
HANGING = Geometry(Pose.from_xyz_rpy((0.0, 0.0, 2.8), (math.pi, 0.0, 0.0)))
LIMITS = Limits()


def dh(theta, d, a, alpha):
    """Return the matrix of a row of a Denavit-Hartenberg table."""
    c, s, ca, sa = math.cos(theta), math.sin(theta), math.cos(alpha), math.sin(alpha)
    return np.array([[c, -s * ca, s * sa, a * c], [s, c * ca, -c * sa, a * s], [0, sa, ca, d], [0, 0, 0, 1]])


@given(angles, angles, st.floats(0.1, 20.0))
def test_the_table_of_the_workshop(pan, tilt, distance):
    rows = dh(pan, 0, 0, math.pi / 2) @ dh(tilt, 0, 0, -math.pi / 2) @ dh(0, distance, 0, 0)
    assert Geometry().point(Angles(pan, tilt), distance) == pytest.approx(tuple(rows[:3, 3]), abs=1e-9)
    closed = np.array([-math.cos(pan) * math.sin(tilt), -math.sin(pan) * math.sin(tilt), math.cos(tilt)])
    assert rows[:3, 3] == pytest.approx(distance * closed, abs=1e-9)


@given(angles, st.floats(0.1, math.pi - 0.1), small, small, small, st.floats(0.5, 10.0), angles)
def test_both_solutions_aim_at_the_point(pan, tilt, zero, axis_skew, beam_skew, distance, yaw):
    geometry = Geometry(Pose.from_xyz_rpy((1.0, -2.0, 3.0), (0.3, -0.2, yaw)), zero, axis_skew, beam_skew)
    point = geometry.point(Angles(pan, tilt - zero), distance)
    first, second = geometry.solutions(point)
    for one in (first, second):
        assert geometry.point(one, distance) == pytest.approx(point, abs=1e-9)
    assert math.cos(first.pan - pan) == pytest.approx(1.0, abs=1e-9)
    assert first.tilt == pytest.approx(tilt - zero, abs=1e-9)
    # Without skews the other one is the flip: half a turn of pan, and the opposite tilt.
    if axis_skew == beam_skew == zero == 0.0:
        assert math.cos(second.pan - pan) == pytest.approx(-1.0)
        assert second.tilt == pytest.approx(-tilt)


@settings(max_examples=30)
@given(st.lists(st.tuples(st.floats(-3, 3), st.floats(-3, 3)), min_size=2, max_size=5))
@example([(0.0, 0.0), (0.0, 0.0078125)])
@example([(0.0, 0.0), (0.0, 8.021903731432351e-07)])
def test_a_target_that_moves_steadily_never_turns_the_head_round(corners):
    limits = Limits(pan=(-40.0, 40.0))  # pan without an end
    place, was_on_axis = (1.0, 0.5), False
    current = aim(HANGING, limits, (*place, 0.8), Angles(0.0, 0.0))
    for corner in corners:
        step = math.dist(corner, place) / 100
        for share in np.linspace(0.0, 1.0, 101)[1:].tolist():
            x, y = (start + share * (end - start) for start, end in zip(place, corner, strict=True))
            before, current = current, aim(HANGING, limits, (x, y, 0.8), current)
            # Near the pan axis pan must turn fast, and on it pan is kept until the target leaves it: see below.
            if math.hypot(x, y) > 3 * step and not was_on_axis:
                assert abs(current.pan - before.pan) <= 2.0 * step / math.hypot(x, y) + 1e-7
                assert abs(current.tilt - before.tilt) <= step + 1e-7  # an arc cosine near 1 is not exact
            was_on_axis = off_axis_angle(HANGING, (x, y, 0.8)) <= AXIS_TOLERANCE
        place = corner


def test_through_the_pan_axis_tilt_goes_through_zero_and_pan_stays():
    current = aim(HANGING, LIMITS, (-1.0, 0.0, 0.8), Angles(0.0, 0.0))
    start = current.pan
    for x in np.linspace(-1.0, 1.0, 201):
        current = aim(HANGING, LIMITS, (x, 0.0, 0.8), current)
        assert current.pan == pytest.approx(start, abs=1e-9)
        assert HANGING.point(current, math.hypot(x, 2.0)) == pytest.approx((x, 0.0, 0.8), abs=1e-9)


@given(angles, st.floats(0.0, 1.0), st.floats(-4.0, 4.0))
def test_near_the_pan_axis_pan_is_kept_and_the_beam_is_off_by_the_tolerance_at_most(azimuth, share, pan):
    radius = 2.0 * share * AXIS_TOLERANCE * 0.99
    point = (radius * math.cos(azimuth), radius * math.sin(azimuth), 0.8)
    found = aim(HANGING, LIMITS, point, Angles(pan, 0.0))
    assert found.pan == pan
    reached = HANGING.point(found, 2.0)
    assert math.dist(reached, point) <= 2 * 2.0 * AXIS_TOLERANCE
    assert off_axis_angle(HANGING, point) == pytest.approx(radius / 2.0, rel=1e-3, abs=1e-12)


def test_the_flip_is_taken_where_pan_ends():
    limits = Limits(pan=(-1.0, 1.0), tilt=(-2.0, 2.0))
    found = aim(Geometry(), limits, (1.0, 0.1, 1.0), Angles(0.0, 0.5))  # pan of the first solution is near pi
    assert limits.allow(found)
    assert Geometry().point(found, math.sqrt(2.01)) == pytest.approx((1.0, 0.1, 1.0))


@pytest.mark.parametrize(
    ("point", "words"),
    [
        ((0.0, 0.0, 9.0), "out of range: it needs pan"),
        ((math.nan, 0.0, 0.0), "is not finite"),
        ((math.inf, 0.0, 0.0), "is not finite"),
        ((0.0, 0.0, 2.8), "is where the head is"),
    ],
)
def test_points_that_cannot_be_aimed_at(point, words):
    with pytest.raises(PointingError, match=words):
        aim(HANGING, LIMITS, point, Angles(0.0, 0.0))


def trapezoid(distance, speed, acceleration):
    """Return how long a movement from rest to rest takes."""
    if distance < speed**2 / acceleration:
        return 2 * math.sqrt(distance / acceleration)
    return distance / speed + speed / acceleration


@given(st.floats(-4.0, 4.0), st.floats(-2.0, 2.0), st.floats(0.005, 0.03))
def test_a_movement_keeps_its_limits_and_ends_without_overshoot(pan, tilt, dt):
    motion = Motion(Angles(0.0, 0.0), LIMITS)
    motion.target = Angles(pan, tilt)
    before, steps = motion.speeds, 0
    while motion.is_moving:
        motion.step(dt)
        assert abs(motion.speeds.pan) <= LIMITS.pan_speed + 1e-9
        assert abs(motion.speeds.pan - before.pan) <= LIMITS.acceleration * dt + 1e-6 / dt
        assert 0.0 <= motion.angles.pan / (pan or 1.0) <= 1.0 + 1e-9
        before, steps = motion.speeds, steps + 1
        assert steps < 2000
    assert motion.angles == Angles(pan, tilt)
    expected = max(trapezoid(abs(one), 4.0, 20.0) for one in (pan, tilt))
    assert steps * dt == pytest.approx(expected, abs=4 * dt)


@given(st.lists(st.floats(-3.0, 3.0), min_size=2, max_size=10), st.integers(1, 30))
def test_a_new_target_on_the_way_changes_no_speed_abruptly(targets, steps):
    motion, dt = Motion(Angles(0.0, 0.0), LIMITS), 1 / 44
    before = 0.0
    for target in targets:
        motion.target = Angles(target, 0.0)
        for _ in range(steps):
            motion.step(dt)
            assert abs(motion.speeds.pan - before) <= LIMITS.acceleration * dt + 1e-4
            before = motion.speeds.pan
    for _ in range(1000):
        motion.step(dt)
    assert motion.angles.pan == targets[-1]
