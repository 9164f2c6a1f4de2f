"""Limits of velocity and acceleration, dead band, time-out."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.common.parameters import ParameterError
from daidalos.navigation.velocity_smoother import MeasuredVelocity, VelocitySmoother, VelocitySmootherParameters

component = st.floats(-5.0, 5.0)


@given(st.lists(st.tuples(component, component, component), min_size=1, max_size=30), st.booleans())
def test_limits_hold_whatever_is_commanded(commands, scale):
    parameters = VelocitySmootherParameters(
        scale_velocities=scale,
        max_velocity=(0.5, 0.2, 1.0),
        min_velocity=(-0.3, -0.2, -1.0),
        max_accel=(2.0, 1.0, 3.0),
        max_decel=(-4.0, -1.0, -3.0),
    )
    smoother = VelocitySmoother(parameters)
    last = np.zeros(3)
    for number, command in enumerate(commands):
        now = 0.05 * number
        smoother.command(np.array(command), now)
        velocity = smoother.step(now)
        assert (velocity <= np.array(parameters.max_velocity) + 1e-9).all()
        assert (velocity >= np.array(parameters.min_velocity) - 1e-9).all()
        assert (np.abs(velocity - last) <= 0.05 * np.array([4.0, 1.0, 3.0]) + 1e-9).all()
        last = velocity


def test_speeding_up_and_braking_have_their_own_limits():
    parameters = VelocitySmootherParameters(max_accel=(1.0, 0.0, 1.0), max_decel=(-3.0, 0.0, -1.0))
    smoother = VelocitySmoother(parameters)
    smoother.command(np.array([0.5, 0.0, 0.0]), 0.0)
    up = [smoother.step(0.05 * k)[0] for k in range(12)]
    assert np.allclose(up[:10], 0.05 * np.arange(1, 11))
    assert up[-1] == pytest.approx(0.5)
    smoother.command(np.zeros(3), 0.6)
    down = [smoother.step(0.6 + 0.05 * k)[0] for k in range(4)]
    assert np.allclose(down, [0.35, 0.2, 0.05, 0.0])


def test_scaling_keeps_the_direction():
    smoother = VelocitySmoother(VelocitySmootherParameters(scale_velocities=True))
    smoother.command(np.array([0.5, 0.0, 2.0]), 0.0)
    first = smoother.step(0.0)
    assert first[2] / first[0] == pytest.approx(4.0)


def test_a_command_that_is_too_old_stops_the_robot_and_then_is_silent():
    smoother = VelocitySmoother(VelocitySmootherParameters(velocity_timeout=0.5))
    assert smoother.step(0.0) is None
    smoother.command(np.array([0.2, 0.0, 0.0]), 0.0)
    for k in range(10):
        smoother.step(0.05 * k)
    sent = [smoother.step(0.6 + 0.05 * k) for k in range(10)]
    assert sent[0][0] < 0.2
    assert sent[-1] is None
    assert any(v is not None and not v.any() for v in sent)


def test_closed_loop_begins_at_the_measured_velocity():
    smoother = VelocitySmoother(VelocitySmootherParameters(feedback="CLOSED_LOOP"))
    smoother.command(np.array([0.5, 0.0, 0.0]), 0.0)
    assert smoother.step(0.0, np.array([0.3, 0.0, 0.0]))[0] == pytest.approx(0.425)


def test_the_dead_band_sends_nothing_small():
    smoother = VelocitySmoother(VelocitySmootherParameters(deadband_velocity=(0.05, 0.0, 0.1)))
    smoother.command(np.array([0.04, 0.0, 0.05]), 0.0)
    assert not smoother.step(0.0).any()


def test_a_command_that_is_not_finite_is_a_stop():
    smoother = VelocitySmoother()
    smoother.command(np.array([np.nan, 0.0, 1.0]), 0.0)
    assert not smoother.step(0.0).any()


@pytest.mark.parametrize(
    "values",
    [{"feedback": "OPEN"}, {"max_accel": (-1.0, 0.0, 0.0)}, {"min_velocity": (1.0, 0.0, 0.0)}],
)
def test_parameters_that_make_no_sense_are_refused(values):
    with pytest.raises(ParameterError):
        VelocitySmootherParameters(**values)


def test_a_command_does_not_outlast_a_clock_that_is_set_back():
    smoother = VelocitySmoother()
    smoother.command(np.array([0.1, 0.0, 0.0]), 100.0)
    assert smoother.step(100.0)[0] == pytest.approx(0.1)
    assert not smoother.step(3.0).any()
    assert smoother.step(3.05) is None


def test_measured_velocities_are_averaged_and_forgotten():
    measured = MeasuredVelocity(0.1)
    assert measured.at(0.0) is None
    for k in range(4):
        measured.add(np.array([float(k), 0.0, 0.0]), 0.04 * k)
    assert measured.at(0.12)[0] == pytest.approx(2.0)
    assert measured.at(1.0) is None
    measured.add(np.array([7.0, 0.0, 0.0]), 0.05)
    assert measured.at(0.05)[0] == 7.0
