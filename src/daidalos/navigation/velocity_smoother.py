"""Velocity smoother: limits on velocity and acceleration, dead band and timeout."""

from collections import deque
from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import ParameterError, Parameters, parameter

_MAX_AGE_S = 0.5
"""Age [s] from which a measured velocity is not that of the robot any more."""


@dataclass(frozen=True)
class VelocitySmootherParameters(Parameters):
    """Parameters of the smoother, by their Nav2 names; triples are (x, y, yaw)."""

    smoothing_frequency: float = parameter(20.0, "How often commands are published.", unit="Hz", above=0.0)
    scale_velocities: bool = parameter(False, "Whether all velocities are scaled when one is limited.")
    feedback: str = parameter(
        "OPEN_LOOP", "Where the present velocity comes from: the last command or odometry.",
        choices=("OPEN_LOOP", "CLOSED_LOOP"),
    )  # fmt: skip
    max_velocity: tuple[float, float, float] = parameter(
        (0.5, 0.0, 2.5), "Largest velocities.", unit="m/s, m/s, rad/s", length=3
    )
    min_velocity: tuple[float, float, float] = parameter(
        (-0.5, 0.0, -2.5), "Least velocities.", unit="m/s, m/s, rad/s", length=3
    )
    max_accel: tuple[float, float, float] = parameter(
        (2.5, 0.0, 3.2), "Largest accelerations.", unit="m/s^2, m/s^2, rad/s^2", length=3, minimum=0.0
    )
    max_decel: tuple[float, float, float] = parameter(
        (-2.5, 0.0, -3.2), "Largest decelerations, negative.", unit="m/s^2, m/s^2, rad/s^2", length=3, maximum=0.0
    )
    deadband_velocity: tuple[float, float, float] = parameter(
        (0.0, 0.0, 0.0), "Velocities below which zero is commanded.", unit="m/s, m/s, rad/s", length=3
    )
    velocity_timeout: float = parameter(1.0, "Age at which a command is ignored.", unit="s")

    def check(self) -> None:
        """Raise an error if minimum velocities are above the maximum ones."""
        if any(low > high for low, high in zip(self.min_velocity, self.max_velocity, strict=True)):
            raise ParameterError("min_velocity", "is above max_velocity")


class VelocitySmoother:
    """Smoother of velocity commands, which are changed as little as the limits require."""

    Parameters = VelocitySmootherParameters

    def __init__(self, parameters: VelocitySmootherParameters | None = None) -> None:
        self.parameters = parameters or VelocitySmootherParameters()
        self._command = np.zeros(3)
        self._commanded_at: float | None = None
        self._last = np.zeros(3)

    @property
    def is_moving(self) -> bool:
        """Whether the last velocity was not zero."""
        return bool(self._last.any())

    def command(self, velocity: Array, now: float) -> None:
        """Set the wanted velocity (x, y, yaw); one that is not finite means stop."""
        self._command = velocity.copy() if np.isfinite(velocity).all() else np.zeros(3)
        self._commanded_at = now

    def step(self, now: float, measured: Array | None = None) -> Array | None:
        """Compute the velocity of the next period.

        Parameters
        ----------
        now : float
            Time [s].
        measured : ndarray, shape (3,), optional
            Velocity from odometry, for `CLOSED_LOOP`.

        Returns
        -------
        ndarray, shape (3,) or None
            Velocity (x, y, yaw); `None` where nothing has to be sent: no command yet, or one that has timed
            out after which the robot stands.
        """
        p = self.parameters
        if self._commanded_at is None:
            return None
        timed_out = not 0.0 <= now - self._commanded_at <= p.velocity_timeout  # before it: the clock was set back
        if timed_out and not self.is_moving:
            return None
        wanted = np.zeros(3) if timed_out else np.clip(self._command, p.min_velocity, p.max_velocity)
        closed = p.feedback == "CLOSED_LOOP" and measured is not None
        present = measured if closed and measured is not None else self._last
        self._last = self._towards(present, wanted)
        return np.where(np.abs(self._last) < p.deadband_velocity, 0.0, self._last)

    def _towards(self, present: Array, wanted: Array) -> Array:
        """Return the velocity limited by acceleration, for each component or by a common ratio."""
        p = self.parameters
        period = 1.0 / p.smoothing_frequency
        change = wanted - present
        speeding = np.abs(wanted) >= np.abs(present)
        speeding &= wanted * present >= 0.0
        allowed = np.where(speeding, p.max_accel, np.negative(p.max_decel)) * period
        share = np.divide(allowed, np.abs(change), out=np.ones(3), where=np.abs(change) > allowed)
        if p.scale_velocities:
            share = np.full(3, share.min())
        reached: Array = present + share * change
        return reached


class MeasuredVelocity:
    """Mean of the velocities that were measured lately.

    Parameters
    ----------
    duration : float
        Time over which they are averaged [s].
    """

    def __init__(self, duration: float) -> None:
        self.duration = duration
        self._samples: deque[tuple[float, Array]] = deque()

    def add(self, velocity: Array, now: float) -> None:
        """Add a velocity (x, y, yaw) that was measured at a time [s]."""
        if self._samples and now < self._samples[-1][0]:  # the clock was set back
            self._samples.clear()
        self._samples.append((now, velocity))
        while now - self._samples[0][0] > self.duration:
            self._samples.popleft()

    def at(self, now: float) -> Array | None:
        """Return the mean, None where nothing was measured in the last half second."""
        if not self._samples or not 0.0 <= now - self._samples[-1][0] <= _MAX_AGE_S:
            return None
        mean: Array = np.mean([velocity for _, velocity in self._samples], axis=0)
        return mean
