"""Limits of speed, acceleration and jerk."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.common.parameters import ParameterError
from daidalos.control.speed_limiter import SpeedLimiter, SpeedLimits

PERIOD = 0.02


def follow(limits: SpeedLimits, wanted: list[float]) -> np.ndarray:
    """Return the allowed velocities for wanted ones, from rest."""
    limiter = SpeedLimiter(limits)
    allowed = [0.0, 0.0]
    for velocity in wanted:
        allowed.append(limiter.limit(velocity, allowed[-1], allowed[-2], PERIOD))
    return np.array(allowed[2:])


def test_without_limits_everything_passes() -> None:
    wanted = [1e3, -1e3, 0.5]
    assert follow(SpeedLimits(), wanted) == pytest.approx(wanted)


def test_speed_is_clamped_on_both_sides() -> None:
    assert follow(SpeedLimits(max_velocity=1.0), [5.0, -5.0]) == pytest.approx([1.0, -1.0])
    assert follow(SpeedLimits(max_velocity=1.0, min_velocity=-0.3), [5.0, -5.0]) == pytest.approx([1.0, -0.3])


def test_a_ramp_takes_as_long_as_the_acceleration_says() -> None:
    speeds = follow(SpeedLimits(max_acceleration=2.0), [1.0] * 30)
    assert speeds[:25] == pytest.approx(2.0 * PERIOD * np.arange(1, 26))
    assert speeds[25:] == pytest.approx(1.0)


def test_braking_and_reversing_have_their_own_rates() -> None:
    limits = SpeedLimits(
        max_acceleration=1.0, max_deceleration=-4.0, max_acceleration_reverse=-0.5, max_deceleration_reverse=2.0
    )
    speeds = follow(limits, [1.0] * 60 + [-1.0] * 150 + [1.0] * 100)
    change = np.diff(np.concatenate(([0.0], speeds))) / PERIOD
    before = np.concatenate(([0.0], speeds[:-1]))
    braking = (before > 0.1) & (change < 0)
    assert change[braking] == pytest.approx(-4.0)
    assert change[(before < -0.01) & (before > -0.98) & (change < 0)] == pytest.approx(-0.5)
    assert change[(before < -0.1) & (change > 0)] == pytest.approx(2.0)


def test_braking_through_zero_shares_the_cycle() -> None:
    limiter = SpeedLimiter(SpeedLimits(max_acceleration=1.0, max_deceleration=-4.0))
    # Half of the cycle brings the speed to zero, the other half speeds up backwards.
    assert limiter.limit(-1.0, 2.0 * PERIOD, 2.0 * PERIOD, PERIOD) == pytest.approx(-0.5 * PERIOD)


@given(st.lists(st.floats(-3.0, 3.0), min_size=1, max_size=60))
def test_jerk_stays_within_its_limit(wanted: list[float]) -> None:
    speeds = np.concatenate(([0.0, 0.0], follow(SpeedLimits(max_jerk=5.0), wanted)))
    assert np.all(np.abs(np.diff(speeds, 2)) <= 5.0 * PERIOD**2 + 1e-12)


@given(st.lists(st.floats(-3.0, 3.0), min_size=1, max_size=60))
def test_speed_and_acceleration_hold_together(wanted: list[float]) -> None:
    speeds = follow(SpeedLimits(max_velocity=1.0, max_acceleration=2.0), wanted)
    assert np.all(np.abs(speeds) <= 1.0)
    assert np.all(np.abs(np.diff(np.concatenate(([0.0], speeds)))) <= 2.0 * PERIOD + 1e-12)


def test_limits_that_are_switched_off_do_not_hold() -> None:
    given = {"max_velocity": 1.0, "max_acceleration": 2.0, "max_deceleration": -2.0, "max_jerk": 5.0}
    off = {f"has_{kind}_limits": False for kind in ("velocity", "acceleration", "jerk")}
    assert follow(SpeedLimits(**given, **off), [7.0, -7.0]) == pytest.approx([7.0, -7.0])
    only_speed = SpeedLimits(**given, has_acceleration_limits=False, has_jerk_limits=False)
    assert follow(only_speed, [7.0, -7.0]) == pytest.approx([1.0, -1.0])


def test_zero_acceleration_and_jerk_are_no_limits() -> None:
    limits = SpeedLimits(max_velocity=1.0, max_acceleration=0.0, max_jerk=0.0, min_jerk=0.0)
    assert follow(limits, [7.0, -7.0]) == pytest.approx([1.0, -1.0])


def test_contradictions_are_named() -> None:
    with pytest.raises(ParameterError, match=r"'linear\.x\.min_velocity' is above max_velocity: 2 > 1"):
        SpeedLimiter(SpeedLimits(max_velocity=1.0, min_velocity=2.0), "linear.x")
    with pytest.raises(ParameterError, match="max_acceleration' must not be negative"):
        SpeedLimiter(SpeedLimits(max_acceleration=-1.0))
