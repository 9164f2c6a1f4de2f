"""The filters against closed forms: a linear Kalman filter, a circle, their own uncertainty."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from daidalos.localization.errors import LocalizationError
from daidalos.localization.filters.kalman import (
    Control,
    ExtendedKalmanFilter,
    KalmanFilter,
    Measurement,
    UnscentedKalmanFilter,
    square,
)
from daidalos.localization.filters.model import jacobian, move

KINDS = [ExtendedKalmanFilter, UnscentedKalmanFilter]


def make(kind: type[KalmanFilter], noise: float = 0.01, **settings: Any) -> KalmanFilter:
    return kind(noise * np.eye(15), np.zeros(15), 0.01 * np.eye(15), **settings)


def measured(time: float, variance: float = 0.01, threshold: float = np.inf, **values: float) -> Measurement:
    names = ["x", "y", "z", "roll", "pitch", "yaw", "vx", "vy", "vz", "vroll", "vpitch", "vyaw", "ax", "ay", "az"]
    at = np.array([names.index(name) for name in values])
    return Measurement(time, at, np.array([*values.values()]), variance * np.eye(len(at)), threshold)


@pytest.mark.parametrize("seed", range(3))
def test_the_jacobian_is_that_of_finite_differences(seed: int) -> None:
    state, step = np.random.default_rng(seed).normal(scale=0.4, size=15), 1e-6
    steps = step * np.eye(15)
    ends = [move(state[:, None] + sign * steps, 0.1) for sign in (1, -1)]
    differences = (ends[0] - ends[1]) / (2 * step)
    np.testing.assert_allclose(jacobian(state, 0.1), differences, atol=1e-8)


@pytest.mark.parametrize("kind", KINDS)
def test_along_a_line_the_filter_is_the_linear_one(kind: type[KalmanFilter]) -> None:
    """On a line with nothing turning, x, vx and ax follow the textbook's matrices."""
    # An uncertain heading, which would make y uncertain too, is left out by having no covariance.
    covariance, noise = np.zeros((15, 15)), np.zeros((15, 15))
    line = [0, 6, 12]
    covariance[line, line], noise[line, line] = 0.5, 0.1
    filter_ = kind(noise, np.zeros(15), covariance)
    state, known, dt = np.zeros(3), 0.5 * np.eye(3), 0.1
    motion = np.array([[1, dt, 0.5 * dt**2], [0, 1, dt], [0, 0, 1]])
    seen, rng = np.array([[1.0, 0, 0], [0, 1.0, 0]]), np.random.default_rng(0)
    filter_.process(measured(0.0, 0.2, x=1.0, vx=0.3))
    state[:2], known[0, 0], known[1, 1] = (1.0, 0.3), 0.2, 0.2
    for i in range(1, 40):
        values = rng.normal(size=2)
        filter_.process(measured(i * dt, 0.2, x=values[0], vx=values[1]))
        state, known = motion @ state, motion @ known @ motion.T + 0.1 * dt * np.eye(3)
        gain = known @ seen.T @ np.linalg.inv(seen @ known @ seen.T + 0.2 * np.eye(2))
        state, known = state + gain @ (values - seen @ state), known - gain @ seen @ known
    np.testing.assert_allclose(filter_.state[line], state, rtol=1e-5, atol=1e-7)
    np.testing.assert_allclose(filter_.covariance[np.ix_(line, line)], known, rtol=1e-5, atol=1e-7)


@pytest.mark.parametrize("kind", KINDS)
def test_a_circle_closes(kind: type[KalmanFilter]) -> None:
    filter_, turn = make(kind), 2 * np.pi / 4
    for i in range(401):
        filter_.process(measured(0.01 * i, 1e-6, vx=1.0, vy=0.0, vz=0.0, vyaw=turn, vroll=0.0, vpitch=0.0))
    assert np.hypot(*filter_.state[:2]) < 0.03
    assert abs(filter_.state[5]) < 0.01


@pytest.mark.parametrize("kind", KINDS)
def test_the_error_is_as_large_as_the_covariance_says(kind: type[KalmanFilter]) -> None:
    rng, distances = np.random.default_rng(2), []
    for _ in range(20):
        filter_, truth = (
            kind(np.diag([0.0] * 6 + [0.05] * 6 + [0.0] * 3), np.zeros(15), np.zeros((15, 15))),
            np.zeros(15),
        )
        filter_.time = 0.0
        for i in range(1, 20):
            truth = move(truth[:, None], 0.1)[:, 0]
            truth[6:12] += rng.normal(scale=np.sqrt(0.005), size=6)
            values = truth[[0, 1, 2, 5]] + rng.normal(scale=0.1, size=4)
            filter_.process(measured(0.1 * i, 0.01, **dict(zip(("x", "y", "z", "yaw"), values.tolist(), strict=True))))
        error = (truth - filter_.state)[[0, 1, 2, 5]]
        distances.append(error @ np.linalg.solve(filter_.covariance[np.ix_([0, 1, 2, 5], [0, 1, 2, 5])], error))
    assert 2.0 < np.mean(distances) < 7.0  # four variables: 4, with a deviation of 0.63


def test_angles_are_corrected_over_the_half_turn() -> None:
    filter_ = make(ExtendedKalmanFilter)
    filter_.process(measured(0.0, yaw=3.1))
    filter_.process(measured(0.1, yaw=-3.1))
    assert abs(filter_.state[5]) > 3.1


def test_an_outlier_is_rejected_and_changes_nothing() -> None:
    filter_ = make(ExtendedKalmanFilter)
    filter_.process(measured(0.0, x=0.0))
    assert not filter_.process(measured(0.0, threshold=3.0, x=5.0))
    assert filter_.state[0] == 0.0
    assert filter_.process(measured(0.0, threshold=3.0, x=0.1))


def test_a_late_measurement_corrects_without_going_back() -> None:
    filter_ = make(ExtendedKalmanFilter)
    filter_.process(measured(1.0, x=0.0))
    filter_.process(measured(0.5, x=0.1))
    assert filter_.time == 1.0
    assert 0.0 < filter_.state[0] < 0.1


def test_the_pose_of_a_robot_that_stands_stays_certain_with_scaled_noise() -> None:
    filter_ = make(ExtendedKalmanFilter, scales_noise=True)
    filter_.process(measured(0.0, 1e-9, x=0.0, vx=0.0))
    before = filter_.covariance[5, 5]
    filter_.covariance[9:12, 9:12] = 0.0
    filter_.predict_to(1.0)
    assert filter_.covariance[5, 5] == pytest.approx(before)


def test_a_command_accelerates_within_its_limits() -> None:
    used, ones = np.array([True, False, False, False, False, True]), np.ones(6)
    control = Control(used, 0.5 * ones, 2.0 * ones, ones, ones)
    np.testing.assert_allclose(control.acceleration(2.0 * ones, np.zeros(6)), 0.5 * ones)
    np.testing.assert_allclose(control.acceleration(np.zeros(6), 5.0 * ones), -2.0 * ones)
    filter_ = make(ExtendedKalmanFilter, control=control)
    filter_.process(measured(0.0, vx=0.0))
    filter_.command = np.array([2.0, 0, 0, 0, 0, 2.0])
    filter_.predict_to(0.1)
    np.testing.assert_allclose(filter_.state[[6, 7, 11]], [0.05, 0.0, 0.05], atol=1e-12)


@pytest.mark.parametrize(("value", "variance"), [(np.nan, 1.0), (0.0, np.nan), (0.0, -1.0), (np.inf, 1.0)])
def test_numbers_that_cannot_be_used_are_refused(value: float, variance: float) -> None:
    with pytest.raises(LocalizationError):
        measured(0.0, variance, x=value)


def test_a_covariance_has_15_or_225_numbers() -> None:
    assert square([1.0] * 15, "q")[3, 3] == 1.0
    assert square(np.eye(15).ravel().tolist(), "q").shape == (15, 15)
    with pytest.raises(LocalizationError, match="'q' must have 15 variances or 225 elements, got 3"):
        square([1.0] * 3, "q")
