"""Turning on the spot: fast, and without overshoot."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.navigation.controllers.rotation import rotation_speed


@given(
    angle=st.floats(-6.0, 6.0),
    speed=st.floats(-0.5, 0.5),
    max_speed=st.floats(0.3, 2.0),
    max_accel=st.floats(0.5, 6.0),
)
def test_a_turn_ends_at_rest_without_overshoot(angle, speed, max_speed, max_accel):
    speed = speed if speed * angle >= 0.0 and speed**2 / (2.0 * max_accel) < 0.5 * abs(angle) else 0.0
    period, left = 0.05, angle
    for _ in range(2000):
        last = speed
        speed = rotation_speed(left, speed, max_speed=max_speed, max_accel=max_accel, period=period)
        assert abs(speed) <= max(max_speed, abs(last)) + 1e-9
        assert abs(speed - last) <= max_accel * period + 1e-9
        left -= speed * period
        if abs(left) < 1e-3 and abs(speed) < 0.05:
            break
    assert abs(left) < 0.01
    assert left * angle >= -0.02 * abs(angle) - 0.02


def test_a_long_turn_takes_little_more_than_its_trapezoid():
    period, left, speed, cycles = 0.05, 3.0, 0.0, 0
    while abs(left) > 0.02 and cycles < 1000:
        speed = rotation_speed(left, speed, max_speed=1.0, max_accel=3.2, period=period)
        left -= speed * period
        cycles += 1
    assert cycles * period == pytest.approx(3.0 + 1.0 / 3.2, abs=0.3)
