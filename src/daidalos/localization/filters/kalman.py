"""Extended and unscented Kalman filters of the 15-variable state."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.pose2 import wrap
from daidalos.localization.errors import LocalizationError
from daidalos.localization.filters.model import ACCELERATION, ANGLES, ANGULAR_VELOCITY, SIZE, jacobian, move

MIN_VARIANCE = 1e-9
"""Least variance of a measured variable, which keeps the gain finite."""

_TURNS = slice(3, 6)
"""Where the angular part of a velocity (6,) stands."""


@dataclass(frozen=True)
class Measurement:
    """Measured variables of the state.

    Attributes
    ----------
    time : float
        When they were measured [s].
    indices : ndarray of int, shape (n,)
        Which variables.
    values : ndarray, shape (n,)
    covariance : ndarray, shape (n, n)
    threshold : float
        Mahalanobis distance beyond which the measurement is rejected.

    Raises
    ------
    LocalizationError
        When the values or the covariance are not finite, or a variance is negative.
    """

    time: float
    indices: NDArray[np.intp]
    values: Array
    covariance: Array
    threshold: float = np.inf

    def __post_init__(self) -> None:
        if not np.isfinite(self.values).all():
            raise LocalizationError("a value is not finite")
        if not np.isfinite(self.covariance).all():
            raise LocalizationError("its covariance is not finite")
        if (np.diag(self.covariance) < 0).any():
            raise LocalizationError("its covariance has a negative variance")


@dataclass(frozen=True)
class Control:
    """Commanded velocities, and how fast a body follows them.

    Attributes
    ----------
    is_used : ndarray of bool, shape (6,)
        For the velocities along and about x, y, z.
    acceleration_limits, deceleration_limits : ndarray, shape (6,)
        In m/s^2 and rad/s^2.
    acceleration_gains, deceleration_gains : ndarray, shape (6,)
        Acceleration per difference of velocity [1/s].
    """

    is_used: Array
    acceleration_limits: Array
    deceleration_limits: Array
    acceleration_gains: Array
    deceleration_gains: Array

    def acceleration(self, command: Array, velocity: Array) -> Array:
        """Return the accelerations (6,) of a body with a velocity (6,) that was sent a command (6,)."""
        error = command - velocity
        slows = np.abs(command) < np.abs(velocity)
        slows &= command * velocity >= 0
        limit = np.where(slows, self.deceleration_limits, self.acceleration_limits)
        gain = np.where(slows, self.deceleration_gains, self.acceleration_gains)
        return np.asarray(np.clip(gain * error, -limit, limit))


@dataclass
class KalmanFilter(ABC):
    """Base of the filters: correction, and the steps around a prediction that they share.

    Attributes
    ----------
    process_noise : ndarray, shape (15, 15)
        Covariance that a second adds.
    initial_state : ndarray, shape (15,)
    initial_covariance : ndarray, shape (15, 15)
    scales_noise : bool
        Whether the noise of the pose grows with the speed, so that a body that stands stays certain.
    control : Control or None
    time : float or None
        Of the state [s]; None before the first measurement.
    state : ndarray, shape (15,)
    covariance : ndarray, shape (15, 15)
    command : ndarray or None
        Commanded velocities (6,) that count at the moment.
    """

    process_noise: Array
    initial_state: Array
    initial_covariance: Array
    scales_noise: bool = False
    control: Control | None = None
    time: float | None = field(default=None, init=False)
    command: Array | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """Forget everything measured."""
        self.time, self.command = None, None
        self.state, self.covariance = self.initial_state.copy(), self.initial_covariance.copy()

    def process(self, measurement: Measurement) -> bool:
        """Predict up to a measurement and correct by it; return whether it was not rejected.

        The first measurement is taken over. One from before the state's time corrects the state as it is.
        """
        at, n = measurement.indices, len(measurement.indices)
        if self.time is None:
            self.time = measurement.time
            self.state[at] = measurement.values
            variances = np.maximum(np.diag(measurement.covariance), MIN_VARIANCE)
            self.covariance[at] = self.covariance[:, at] = 0.0
            self.covariance[np.ix_(at, at)] = measurement.covariance
            self.covariance[at, at] = variances
            return True
        if measurement.time > self.time:
            self.predict_to(measurement.time)
        noise = measurement.covariance.copy()
        noise[range(n), range(n)] = np.maximum(np.diag(noise), MIN_VARIANCE)
        return self._correct(at, measurement.values, noise, measurement.threshold)

    def predict_to(self, time: float) -> None:
        """Move the state on to a time [s] that is not before its own."""
        assert self.time is not None
        seconds, self.time = time - self.time, time
        noise = self.process_noise
        if self.scales_noise:
            noise = noise.copy()
            noise[:6, :6] *= float(self.state[6:12] @ self.state[6:12])
        if self.control is not None and self.command is not None:
            wanted = self.control.acceleration(self.command, self.state[6:12])
            linear = self.control.is_used[:3]
            self.state[ACCELERATION] = np.where(linear, wanted[:3], self.state[ACCELERATION])
            turns = np.where(self.control.is_used[_TURNS], wanted[_TURNS], 0.0) * seconds
        else:
            turns = np.zeros(3)
        self._predict(seconds)
        self.state[ANGULAR_VELOCITY] += turns
        self.state[ANGLES] = wrap(self.state[ANGLES])
        self.covariance = self.covariance + seconds * noise

    @abstractmethod
    def _predict(self, seconds: float) -> None:
        """Move state and covariance on, without noise."""

    def _correct(self, at: NDArray[np.intp], values: Array, noise: Array, threshold: float) -> bool:
        """Correct variables that are measured directly; the form of the covariance is Joseph's."""
        innovation = values - self.state[at]
        is_angle = (at >= ANGLES.start) & (at < ANGLES.stop)
        innovation[is_angle] = wrap(innovation[is_angle])
        columns = self.covariance[:, at]
        inverse = np.linalg.inv(columns[at] + noise)
        if innovation @ inverse @ innovation > threshold**2:
            return False
        gain = columns @ inverse
        self.state = self.state + gain @ innovation
        self.state[ANGLES] = wrap(self.state[ANGLES])
        rest = np.eye(SIZE)
        rest[:, at] -= gain
        covariance = rest @ self.covariance @ rest.T + gain @ noise @ gain.T
        self.covariance = 0.5 * (covariance + covariance.T)
        return True


class ExtendedKalmanFilter(KalmanFilter):
    """Filter that moves the covariance by the derivative of the motion."""

    def _predict(self, seconds: float) -> None:
        derivative = jacobian(self.state, seconds)
        self.state = np.asarray(move(self.state[:, None], seconds)[:, 0], dtype=float)
        self.covariance = derivative @ self.covariance @ derivative.T


@dataclass(kw_only=True)
class UnscentedKalmanFilter(KalmanFilter):
    """Filter that moves points of the covariance (Wan and van der Merwe, 2000).

    Attributes
    ----------
    alpha, kappa, beta : float
        Spread of the points, its offset, and what is known of the distribution (2 where it is normal).
    """

    alpha: float = 0.001
    kappa: float = 0.0
    beta: float = 2.0

    def _predict(self, seconds: float) -> None:
        spread = self.alpha**2 * (SIZE + self.kappa)
        values, axes = np.linalg.eigh(self.covariance)
        steps = axes * np.sqrt(spread * np.maximum(values, 0.0))
        # Differences from the middle point, since the weights of a small alpha are so large that sums of angles lose
        # their digits, and angles may lie on both sides of a half turn.
        middle = move(self.state[:, None], seconds)
        points = move(self.state[:, None] + np.hstack([steps, -steps]), seconds)
        differences = np.asarray(points - middle, dtype=float)
        weight = 0.5 / spread
        mean = weight * differences.sum(axis=1)
        self.state = np.asarray(middle[:, 0], dtype=float) + mean
        self.covariance = weight * differences @ differences.T + (self.beta - self.alpha**2) * np.outer(mean, mean)


def square(values: Sequence[float], name: str) -> Array:
    """Return a covariance (15, 15) from its 225 elements or its 15 variances.

    Raises
    ------
    LocalizationError
        When there are other numbers of them, they are not finite, or a variance is negative.
    """
    given = np.asarray(values, dtype=float)
    if given.size not in (SIZE, SIZE * SIZE):
        raise LocalizationError(f"'{name}' must have 15 variances or 225 elements, got {given.size}")
    matrix = np.diag(given) if given.size == SIZE else given.reshape(SIZE, SIZE)
    if not np.isfinite(matrix).all() or (np.diag(matrix) < 0).any():
        raise LocalizationError(f"'{name}' must be finite, with variances of at least 0")
    return matrix
