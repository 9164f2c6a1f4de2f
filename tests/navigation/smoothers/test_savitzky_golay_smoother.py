"""Savitzky-Golay smoothing against SciPy's, and paths with cusps."""

import numpy as np
import pytest
from scipy.signal import savgol_coeffs

from daidalos.common.parameters import ParameterError
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.paths import split_at_cusps, with_headings
from daidalos.navigation.smoothers.savitzky_golay_smoother import (
    SavitzkyGolaySmoother,
    SavitzkyGolaySmootherParameters,
    central_weights,
)
from daidalos.navigation.smoothers.simple_smoother import SimpleSmoother

FREE = Costmap.filled(80, 80, 0.05, (0.0, 0.0))


@pytest.mark.parametrize(("window", "order"), [(7, 3), (5, 2), (9, 1)])
def test_the_weights_are_those_of_scipy(window, order):
    assert central_weights(window, order) == pytest.approx(savgol_coeffs(window, order, use="dot"))


def test_noise_is_reduced_and_a_cubic_stays():
    x = np.linspace(0.5, 3.5, 61)
    cubic = np.stack([x, 2.0 + 0.2 * (x - 2.0) ** 3], axis=-1)
    smoother = SavitzkyGolaySmoother(SavitzkyGolaySmootherParameters(do_refinement=False))
    assert smoother.smooth(with_headings(cubic), FREE)[3:-3, :2] == pytest.approx(cubic[3:-3])
    noisy = cubic + np.random.default_rng(1).normal(0.0, 0.005, cubic.shape)
    noisy[:, 0] = x
    smoothed = smoother.smooth(with_headings(noisy), FREE)
    assert np.std((smoothed - with_headings(cubic))[3:-3, 1]) < 0.7 * np.std((noisy - cubic)[3:-3, 1])
    assert np.array_equal(smoothed[[0, -1], :2], noisy[[0, -1]])


@pytest.mark.parametrize("smoother", [SimpleSmoother(), SavitzkyGolaySmoother()])
def test_a_place_where_the_robot_reverses_stays(smoother):
    ahead = np.stack([np.linspace(1.0, 2.0, 21), np.linspace(1.0, 1.3, 21), np.full(21, 0.29)], axis=-1)
    back = np.stack([np.linspace(1.95, 1.0, 20), np.linspace(1.3, 1.5, 20), np.full(20, -0.2)], axis=-1)
    path = np.concatenate([ahead, back])
    smoothed = smoother.smooth(path, FREE)
    assert [part.shape[0] for part in split_at_cusps(path)] == [21, 21]
    assert smoothed[20, :2] == pytest.approx(path[20, :2])
    assert np.cos(smoothed[25:39, 2]) == pytest.approx(1.0, abs=0.1)  # backwards


@pytest.mark.parametrize(("given", "name"), [({"window_size": 6}, "window_size"), ({"poly_order": 7}, "poly_order")])
def test_windows_that_cannot_be_are_refused(given, name):
    with pytest.raises(ParameterError, match=name):
        SavitzkyGolaySmootherParameters(**given)
