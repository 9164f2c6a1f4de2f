import math

import numpy as np
import pytest

from daidalos.simulation.odometry import EncoderError, PlanarPose, planar_covariance, yaw_quaternion


@pytest.mark.parametrize("pieces", [1, 7, 1000])
def test_arcs_close_whatever_the_step(pieces):
    """A quarter of a circle of radius 2: the chord is exact, not a polygon."""
    pose = PlanarPose(1, 0, math.pi / 2)
    for _ in range(pieces):
        pose = pose.moved(2 * math.pi / 2 / pieces, math.pi / 2 / pieces)
    assert (pose.x, pose.y, pose.yaw) == pytest.approx((-1, 2, math.pi))


def test_straight_and_sideways():
    pose = PlanarPose(0, 0, math.pi / 2).moved(3, 0, 1)
    assert (pose.x, pose.y) == pytest.approx((-1, 3))


@pytest.mark.parametrize("pieces", [10, 1000])
def test_encoder_noise_does_not_depend_on_the_rate(pieces):
    random = np.random.default_rng(0)
    error = EncoderError(noise=0.01)
    ends = sum(error.measure(np.full(4000, 4.0 / pieces), random) for _ in range(pieces))
    assert ends.mean() == pytest.approx(4, abs=0.002)
    assert ends.std() == pytest.approx(0.01 * 2, rel=0.05)


def test_slip_scales_and_rest_is_silent():
    random = np.random.default_rng(0)
    assert EncoderError(slip=0.1).measure(np.array([2.0]), random) == pytest.approx([2.2])
    assert EncoderError(noise=1.0).measure(np.zeros(2), random).tolist() == [0, 0]


def test_forms():
    assert yaw_quaternion(math.pi) == pytest.approx([0, 0, 1, 0])
    covariance = planar_covariance(1, 2, 3).reshape(6, 6)
    assert np.diag(covariance).tolist() == [1, 2, 1e12, 1e12, 1e12, 3]
