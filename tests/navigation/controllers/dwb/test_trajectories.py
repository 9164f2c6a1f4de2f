"""Sampled commands and their trajectories against closed forms and plain arithmetic."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.common.parameters import ParameterError
from daidalos.navigation.controllers.dwb.trajectories import GeneratorParameters, generate
from properties import examples

WAFFLE = {
    "max_vel_x": 0.26,
    "max_speed_xy": 0.26,
    "max_vel_theta": 1.0,
    "acc_lim_x": 2.5,
    "acc_lim_theta": 3.2,
    "decel_lim_x": -2.5,
    "decel_lim_theta": -3.2,
    "linear_granularity": 0.05,
}
LIMITED = "dwb_plugins::LimitedAccelGenerator"


def test_what_the_robot_reaches_in_the_simulated_time_is_sampled():
    found = generate(GeneratorParameters(**WAFFLE), np.zeros(3), np.zeros(3), 0.05, 1.0)
    assert found.commands[:, 0].min() == 0.0
    assert found.commands[:, 0].max() == pytest.approx(0.26)
    assert np.abs(found.commands[:, 2]).max() == pytest.approx(1.0)
    assert not (found.commands == 0.0).all(axis=1).any()
    assert (found.commands[:, 2] == 0.0).any()  # straight ahead is among them


def test_a_limited_generator_samples_what_is_reached_in_a_cycle():
    parameters = GeneratorParameters(**WAFFLE, trajectory_generator_name=LIMITED)
    found = generate(parameters, np.zeros(3), np.array([0.2, 0.0, -0.5]), 0.02, 1.0)
    assert found.commands[:, 0].min() == pytest.approx(0.15)
    assert found.commands[:, 0].max() == pytest.approx(0.25)
    assert found.commands[:, 2].min() == pytest.approx(-0.564)
    assert found.commands[:, 2].max() == pytest.approx(-0.436)


def test_a_constant_velocity_drives_an_arc():
    parameters = GeneratorParameters(**WAFFLE, trajectory_generator_name=LIMITED)
    found = generate(parameters, np.array([1.0, 2.0, 0.5]), np.array([0.2, 0.0, 0.4]), 0.05, 1.0)
    for command, poses, count in zip(found.commands, found.poses, found.counts, strict=True):
        v, w = command[0], command[2]
        radius, end = v / w, 0.5 + 1.7 * w
        expected = [1.0 + radius * (math.sin(end) - math.sin(0.5)), 2.0 - radius * (math.cos(end) - math.cos(0.5)), end]
        assert poses[count - 1] == pytest.approx(expected, abs=1e-4)


@examples(30)
@given(seed=st.integers(0, 10_000), by_time=st.booleans(), last=st.booleans())
def test_poses_are_those_of_plain_arithmetic(seed, by_time, last):
    rng = np.random.default_rng(seed)
    pose, velocity = rng.uniform(-2.0, 2.0, 3), rng.uniform(-0.2, 0.26, 3)
    parameters = GeneratorParameters(
        **{**WAFFLE, "min_vel_x": -0.2, "min_vel_y": -0.1, "max_vel_y": 0.1, "acc_lim_y": 1.0, "decel_lim_y": -1.0},
        vx_samples=3,
        vy_samples=2,
        vtheta_samples=3,
        discretize_by_time=by_time,
        include_last_point=last,
    )
    found = generate(parameters, pose, velocity, 0.05, 1.0)
    gains, losses = (2.5, 1.0, 3.2), (-2.5, -1.0, -3.2)
    for command, poses, count in zip(found.commands, found.poses, found.counts, strict=True):
        steps = int(count) - last
        step = 1.7 / steps
        state, now = pose.copy(), velocity.copy()
        for t in range(steps):
            assert poses[t] == pytest.approx(state)
            for axis in range(3):
                up, down = (gains, losses) if now[axis] >= 0.0 else (-np.array(losses), -np.array(gains))
                now[axis] = np.clip(command[axis], now[axis] + down[axis] * step, now[axis] + up[axis] * step)
            c, s = math.cos(state[2] + 0.5 * now[2] * step), math.sin(state[2] + 0.5 * now[2] * step)
            state += step * np.array([now[0] * c - now[1] * s, now[0] * s + now[1] * c, now[2]])
        if last:
            assert poses[steps] == pytest.approx(state)


def test_commands_keep_to_the_limits_of_speed():
    parameters = GeneratorParameters(
        **{**WAFFLE, "min_vel_y": -0.26, "max_vel_y": 0.26, "acc_lim_y": 2.5, "decel_lim_y": -2.5},
        min_speed_xy=0.1,
        min_speed_theta=0.4,
    )
    found = generate(parameters, np.zeros(3), np.zeros(3), 0.05, 1.0)
    speeds = np.hypot(found.commands[:, 0], found.commands[:, 1])
    assert speeds.max() <= 0.26 + 1e-9
    assert ((speeds >= 0.1 - 1e-9) | (np.abs(found.commands[:, 2]) >= 0.4 - 1e-9)).all()
    slow = generate(parameters, np.zeros(3), np.zeros(3), 0.05, 0.5)
    assert np.hypot(slow.commands[:, 0], slow.commands[:, 1]).max() <= 0.13 + 1e-9
    assert np.abs(slow.commands[:, 2]).max() <= 0.5 + 1e-9


def test_a_minimum_above_its_maximum_is_refused():
    with pytest.raises(ParameterError, match="is above max_vel_x"):
        GeneratorParameters(min_vel_x=0.5, max_vel_x=0.2)


def test_no_samples_of_an_axis_are_its_two_ends_as_with_two() -> None:
    found = [
        generate(GeneratorParameters(**WAFFLE | {"vx_samples": count}), np.zeros(3), np.zeros(3), 0.05, 1.0).commands
        for count in (0, 2)
    ]
    np.testing.assert_array_equal(*found)
