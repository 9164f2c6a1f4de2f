"""Rollouts against plain integration, and noise with the variance it should have."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.navigation.controllers.mppi.rollouts import Limits, Rollouts, correlated_noise
from properties import examples

LIMITS = Limits(-0.2, 0.5, 1.8, -2.5, 2.0, 3.2)


def twin(pose, velocity, controls, noise, step):
    """Drive one sample with plain arithmetic."""
    x, y, yaw = pose
    v, w = velocity[0], velocity[2]
    states = []
    for wanted_v, wanted_w in controls + noise:
        wanted_v = min(max(wanted_v, LIMITS.vx_min), LIMITS.vx_max)
        wanted_w = min(max(wanted_w, -LIMITS.wz_max), LIMITS.wz_max)
        forward, backward = LIMITS.ax_max * step, -LIMITS.ax_min * step
        up, down = (forward, backward) if v >= 0.0 else (backward, forward)
        v = min(max(wanted_v, v - down), v + up)
        w = min(max(wanted_w, w - LIMITS.az_max * step), w + LIMITS.az_max * step)
        x += v * step * math.cos(yaw + 0.5 * w * step)
        y += v * step * math.sin(yaw + 0.5 * w * step)
        yaw += w * step
        states.append((x, y, yaw, v, w))
    return np.array(states)


@examples(30)
@given(seed=st.integers(0, 10_000))
def test_samples_are_driven_as_plain_arithmetic_drives_them(seed):
    generator = np.random.default_rng(seed)
    pose, velocity = generator.uniform(-3.0, 3.0, 3), generator.uniform(-0.2, 0.5, 3)
    controls = generator.normal(0.2, 0.3, (30, 2)).astype(np.float32)
    noise = generator.normal(0.0, 0.8, (7, 30, 2)).astype(np.float32)
    rollouts = Rollouts.empty(7, 30)
    rollouts.drive(pose, velocity, controls, noise, LIMITS, 0.05)
    for b in range(7):
        expected = twin(pose, velocity, controls.astype(float), noise[b].astype(float), 0.05)
        driven = np.stack([rollouts.x[b], rollouts.y[b], rollouts.yaw[b], rollouts.vx[b], rollouts.wz[b]], axis=-1)
        assert np.allclose(driven, expected, atol=2e-5)


def test_a_robot_that_moves_sideways_is_driven_along_both_axes():
    rollouts = Rollouts.empty(1, 40)
    limits = Limits(-0.2, 0.5, 1.8, -2.5, 2.0, 3.2, vy_max=0.3, ay_min=-1.0, ay_max=1.0)
    controls = np.tile(np.array([0.2, 0.0, -0.9], dtype=np.float32), (40, 1))
    rollouts.drive(
        np.array([1.0, 2.0, math.pi / 2]), np.zeros(3), controls, np.zeros((1, 40, 3), np.float32), limits, 0.1
    )
    assert np.allclose(rollouts.vy[0, :4], [-0.1, -0.2, -0.3, -0.3], atol=1e-6)
    assert rollouts.y[0, -1] == pytest.approx(2.0 + 0.1 * rollouts.vx.sum(), abs=1e-4)
    assert rollouts.x[0, -1] == pytest.approx(1.0 - 0.1 * rollouts.vy.sum(), abs=1e-4)


@examples(20)
@given(seed=st.integers(0, 10_000))
def test_a_robot_that_steers_turns_in_no_tighter_curve(seed):
    rollouts = Rollouts.empty(5, 30)
    limits = Limits(-0.5, 0.5, 1.8, -2.5, 2.0, 9.0, curvature_max=1.25)
    noise = np.random.default_rng(seed).normal(0.0, 1.0, (5, 30, 2)).astype(np.float32)
    rollouts.drive(np.zeros(3), np.zeros(3), np.zeros((30, 2), np.float32), noise, limits, 0.05)
    assert (np.abs(rollouts.wz) <= 1.25 * np.abs(rollouts.vx) + 1e-6).all()


def test_costs_are_forgotten():
    rollouts = Rollouts.empty(2, 3)
    rollouts.costs[:], rollouts.collides[:] = 5.0, True
    zeros = np.zeros((2, 3, 2), dtype=np.float32)
    rollouts.drive(np.zeros(3), np.zeros(3), zeros[0], zeros, LIMITS, 0.1)
    assert not rollouts.costs.any()
    assert not rollouts.collides.any()


@pytest.mark.parametrize("correlation", [0.0, 0.9])
def test_noise_has_unit_variance_and_the_correlation_asked_for(correlation):
    noise = correlated_noise(np.random.default_rng(0), 20_000, 10, correlation)
    assert np.allclose(noise.std(axis=0), 1.0, atol=0.03)
    assert np.allclose(noise.mean(axis=0), 0.0, atol=0.03)
    assert np.mean(noise[:, 4] * noise[:, 5]) == pytest.approx(correlation, abs=0.02)
