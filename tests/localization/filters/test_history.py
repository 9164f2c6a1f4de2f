"""Filters that take in late measurements at their time."""

from __future__ import annotations

import numpy as np
import pytest

from daidalos.localization.filters.history import FilterHistory
from daidalos.localization.filters.kalman import ExtendedKalmanFilter, KalmanFilter, Measurement


def make() -> KalmanFilter:
    return ExtendedKalmanFilter(0.05 * np.eye(15), np.zeros(15), 1e-3 * np.eye(15))


def measured(time: float, index: int, value: float) -> Measurement:
    return Measurement(time, np.array([index]), np.array([value]), np.array([[0.01]]))


def process(estimate: KalmanFilter, history: FilterHistory, *measurements: Measurement) -> None:
    for one in measurements:
        estimate.process(one)
        history.record("a", one, estimate)


WAY = [measured(0.1 * k, 0 if k % 3 else 6, 0.1 * k if k % 3 else 1.0) for k in range(20)]


@pytest.mark.parametrize("late", [1, 7, 18])
def test_a_late_measurement_counts_as_if_it_had_come_in_time(late: int) -> None:
    in_order, estimate = make(), make()
    for one in WAY:
        in_order.process(one)
    history = FilterHistory(5.0)
    process(estimate, history, *WAY[:late], *WAY[late + 1 :])
    estimate.predict_to(2.5)  # what is predicted meanwhile is undone
    undone = history.rewind(estimate, WAY[late].time)
    assert undone == [("a", one) for one in WAY[late + 1 :]]
    process(estimate, history, WAY[late], *(one for _, one in undone))
    assert estimate.time == in_order.time
    np.testing.assert_allclose(estimate.state, in_order.state, atol=1e-12)
    np.testing.assert_allclose(estimate.covariance, in_order.covariance, atol=1e-12)


def test_what_is_older_than_the_history_leaves_the_filter_as_it_is() -> None:
    estimate, history = make(), FilterHistory(0.5)
    process(estimate, history, *WAY)
    before = estimate.state.copy()
    assert history.rewind(estimate, 1.0) is None
    np.testing.assert_array_equal(estimate.state, before)
    assert history.rewind(estimate, 1.45) is not None
    assert estimate.time == pytest.approx(1.4)
    history.clear()
    assert history.rewind(estimate, 1.9) is None
