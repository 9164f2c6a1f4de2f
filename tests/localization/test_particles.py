"""Drawing anew, counting, clustering and averaging particles."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.sparse.csgraph import connected_components
from scipy.stats import chi2, norm

from daidalos.localization.particles import (
    BIN,
    TURNS,
    bins_of,
    heaviest_cluster,
    kld_bound,
    low_variance_indices,
    mean_and_covariance,
)
from properties import examples


@given(
    weights=st.lists(st.floats(0.0, 1.0), min_size=1, max_size=60).filter(lambda w: sum(w) > 1e-3),
    count=st.integers(1, 200),
    offset=st.floats(0.0, 0.999),
)
def test_each_particle_is_chosen_as_often_as_its_weight_says(weights, count, offset):
    share = np.array(weights) / np.sum(weights)
    chosen = low_variance_indices(share, count, offset)
    times = np.bincount(chosen, minlength=share.size)
    assert chosen.size == count
    assert (np.abs(times - count * share) < 1.0 + 1e-6).all()
    twin = np.searchsorted(np.cumsum(share), (np.arange(count) + offset) / count)
    assert (np.abs(np.minimum(twin, share.size - 1) - chosen) <= 1).mean() > 0.9


def test_the_bound_is_the_quantile_of_chi_square():
    for bins in (2, 10, 100, 1000):
        exact = chi2.ppf(0.99, bins - 1) / (2.0 * 0.05)
        assert kld_bound(bins, 0.05, float(norm.ppf(0.99))) == pytest.approx(exact, rel=0.02, abs=2.0)
    assert kld_bound(1, 0.05, 0.99) == 1


def test_bins_go_round_with_the_yaw():
    poses = np.array([[0.1, 0.1, math.pi - 0.01], [0.1, 0.1, -math.pi + 1e-6], [0.1, 0.1, math.pi + 0.01]])
    numbers = bins_of(poses)
    assert numbers[1] == numbers[2]
    assert numbers[0] != numbers[1]
    assert np.unique(bins_of(np.array([[-0.1, 0.0, 0.0], [0.0, -0.1, 0.0], [0.0, 0.0, -0.1]]))).size == 3


@examples(40)
@given(seed=st.integers(0, 10_000))
def test_the_heaviest_cluster_is_that_of_a_graph_of_touching_bins(seed):
    generator = np.random.default_rng(seed)
    centres = generator.uniform((-5.0, -5.0, -math.pi), (5.0, 5.0, math.pi), (6, 3))
    particles = np.repeat(centres, 30, axis=0) + generator.normal(0.0, 0.3, (180, 3))
    weights = generator.random(180)
    cells = np.floor(particles / BIN).astype(int)
    cells[:, 2] %= TURNS
    bins, member = np.unique(cells, axis=0, return_inverse=True)
    apart = np.abs(bins[:, None] - bins[None])
    turn = np.minimum(apart[..., 2], TURNS - apart[..., 2])
    touching = (apart[..., 0] <= 1) & (apart[..., 1] <= 1) & (turn <= 1)
    label = connected_components(touching)[1][member.ravel()]
    heaviest = np.argmax(np.bincount(label, weights))
    assert np.array_equal(heaviest_cluster(particles, weights), label == heaviest)


def test_the_mean_of_yaws_goes_round():
    particles = np.array([[0.0, 0.0, math.pi - 0.1], [2.0, 1.0, -math.pi + 0.1]])
    mean, covariance = mean_and_covariance(particles, np.array([3.0, 3.0]))
    assert np.allclose(mean[:2], [1.0, 0.5])
    assert abs(mean[2]) == pytest.approx(math.pi)
    assert covariance[2, 2] == pytest.approx(0.01)
    assert covariance[0, 1] == pytest.approx(0.5)


def test_the_covariance_is_that_of_numpy():
    generator = np.random.default_rng(1)
    particles, weights = generator.normal(0.0, 0.1, (50, 3)), generator.random(50)
    mean, covariance = mean_and_covariance(particles, weights)
    assert np.allclose(covariance, np.cov(particles.T, aweights=weights, ddof=0), atol=1e-4)
    assert np.allclose(mean[:2], np.average(particles[:, :2], axis=0, weights=weights))
