"""Where a robot may be after a motion: exact without noise, spread as the formulas say with it."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.common.pose2 import between, compose, wrap
from daidalos.localization.config import AmclConfig
from daidalos.localization.motion_models.differential import DifferentialMotionModel
from daidalos.localization.motion_models.omnidirectional import OmniMotionModel

QUIET = AmclConfig(alpha1=0.0, alpha2=0.0, alpha3=0.0, alpha4=0.0, alpha5=0.0)
poses = st.tuples(st.floats(-5.0, 5.0), st.floats(-5.0, 5.0), st.floats(-3.1, 3.1)).map(np.array)


@given(particle=poses, before=poses, after=poses)
@pytest.mark.parametrize("model", [DifferentialMotionModel, OmniMotionModel])
def test_without_noise_particles_move_as_odometry_did(model, particle, before, after):
    moved = model(QUIET).sample(particle[None], before, after, np.random.default_rng(0))[0]
    expected = compose(particle, between(before, after))
    if model is DifferentialMotionModel and math.hypot(*(after - before)[:2]) < 0.02:
        return
    assert np.allclose(moved[:2], expected[:2], atol=1e-9)
    assert abs(float(wrap(moved[2] - expected[2]))) < 1e-9


def spread(model, after, **alphas):
    """Standard deviations along, across and of the yaw after a motion from the origin."""
    config = AmclConfig(**{**{f"alpha{k}": 0.0 for k in range(1, 6)}, **alphas})
    drawn = model(config).sample(np.zeros((40_000, 3)), np.zeros(3), np.array(after), np.random.default_rng(0))
    return drawn.std(axis=0)


def test_noise_of_a_drive_straight_ahead():
    along, _, yaw = spread(DifferentialMotionModel, [2.0, 0.0, 0.0], alpha3=0.04)
    assert along == pytest.approx(0.2 * 2.0, rel=0.03)
    assert yaw == 0.0
    _, across, yaw = spread(DifferentialMotionModel, [2.0, 0.0, 0.0], alpha2=0.01)
    assert across == pytest.approx(2.0 * 0.2, rel=0.05)
    assert yaw == pytest.approx(math.sqrt(2.0) * 0.2, rel=0.03)


def test_noise_of_a_turn():
    assert spread(DifferentialMotionModel, [0.0, 0.0, 1.0], alpha1=0.04)[2] == pytest.approx(0.2, rel=0.03)
    assert spread(OmniMotionModel, [0.0, 0.0, 1.0], alpha4=0.04)[2] == pytest.approx(0.2, rel=0.03)


def test_backing_up_is_no_turn():
    ahead = spread(DifferentialMotionModel, [1.0, 0.0, 0.0], alpha1=0.2)
    back = spread(DifferentialMotionModel, [-1.0, 0.0, 0.0], alpha1=0.2)
    assert np.allclose(ahead, back, atol=1e-6)


def test_sideways_noise_of_an_omnidirectional_robot():
    x, y, _ = spread(OmniMotionModel, [0.0, 2.0, 0.0], alpha5=0.01)
    assert x == pytest.approx(0.2, rel=0.03)
    assert y == pytest.approx(0.0, abs=1e-9)


def test_ros_1s_models_without_correction_take_variances_for_deviations():
    straight = {"before": np.zeros(3), "after": np.array([2.0, 0.0, 0.0])}
    for kind in (DifferentialMotionModel, OmniMotionModel):
        config = AmclConfig(**{f"alpha{k}": 0.0 for k in range(1, 6)} | {"alpha3": 0.1})
        spreads = [
            kind(config, corrected=corrected)
            .sample(np.zeros((40_000, 3)), **straight, generator=np.random.default_rng(0))[:, 0]
            .std()
            for corrected in (True, False)
        ]
        assert spreads == pytest.approx([math.sqrt(0.1) * 2.0, 0.1 * 4.0], rel=0.03)
