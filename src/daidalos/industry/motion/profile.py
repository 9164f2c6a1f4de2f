"""Position on a path over time: pieces of constant acceleration, seen through a moving average that limits the jerk.

A mean over the ramp time of a motion with the acceleration a has a jerk of at most 2 a / ramp time, keeps to the path,
ends where the motion ends, and takes the ramp time more. For a movement from rest to rest it is the S-curve that is
time-optimal for the jerk a / ramp time (Biagiotti and Melchiorri, "Trajectory Planning for Automatic Machines and
Robots", 2008, chapter 4).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_CREEP = 1e-9
"""Greatest speed [1/s] that counts as rest."""


class Profile:
    """Motion from one rest to the next, which can be extended and cut while it goes on.

    Parameters
    ----------
    start_time : float
        Time of its beginning [s].
    start : float
        Position on the path [m].
    ramp_time : float
        Length of the mean [s].
    """

    def __init__(self, start_time: float, start: float, ramp_time: float) -> None:
        self.ramp_time = ramp_time
        self._origin = start
        self._times = np.array([start_time])
        self._positions = np.array([0.0])
        self._speeds = np.array([0.0])
        self._integrals = np.array([0.0])

    @property
    def end_time(self) -> float:
        """Return when the motion has ended [s]."""
        return float(self._times[-1]) + (self.ramp_time if len(self._times) > 1 else 0.0)

    @property
    def times(self) -> Array:
        """Return when the acceleration before the mean changes [s]."""
        return self._times

    def extend(self, s: Array, x: Array) -> None:
        """Append points of the path (N,) with the squares of the speeds at them; the first is where the motion ends.

        Raises
        ------
        ValueError
            Where the motion rests before the last point.
        """
        speeds = np.sqrt(x)
        steps = np.diff(s)
        both = speeds[1:] + speeds[:-1]
        moves = steps > 0.0
        if (both[moves] <= _CREEP).any():
            raise ValueError(f"the motion rests at {s[:-1][moves][both[moves] <= _CREEP][0]:g} m")
        durations = np.where(moves, 2.0 * steps / np.where(moves, both, 1.0), 0.0)
        positions = s - self._origin
        accelerations = np.where(moves, np.diff(speeds) / np.where(moves, durations, 1.0), 0.0)
        areas = positions[:-1] * durations + speeds[:-1] * durations**2 / 2 + accelerations * durations**3 / 6
        self._times = np.concatenate([self._times, self._times[-1] + np.cumsum(durations)])
        self._positions = np.concatenate([self._positions, positions[1:]])
        self._speeds = np.concatenate([self._speeds, speeds[1:]])
        self._integrals = np.concatenate([self._integrals, self._integrals[-1] + np.cumsum(areas)])

    def cut(self, time: float) -> tuple[float, float]:
        """Forget what comes after a time; return the position and the speed before the mean."""
        position, speed, _, integral = (float(one[0]) for one in self._raw(np.array([time])))
        if time < self._times[-1]:
            kept = int(np.searchsorted(self._times, time, side="right"))
            self._times = np.append(self._times[:kept], time)
            self._positions = np.append(self._positions[:kept], position)
            self._speeds = np.append(self._speeds[:kept], speed)
            self._integrals = np.append(self._integrals[:kept], integral)
        return position + self._origin, speed

    def stretch(self, time: float, factor: float) -> None:
        """Slow all that comes after a time, at which the motion rests, by a factor of 1 or more."""
        self._times = time + (self._times - time) * factor
        self._speeds = self._speeds / factor
        self._integrals = self._integrals[0] + (self._integrals - self._integrals[0]) * factor
        self.ramp_time *= factor

    def copy_for(self, start_time: float, start: float, time: float, factor: float) -> Profile:
        """Return the same motion for another path: from a time on, at which it rests, with all ways times a factor."""
        other = Profile(start_time, start, self.ramp_time)
        first = int(np.searchsorted(self._times, time - 1e-12))
        other._times = start_time + (self._times[first:] - time)
        other._positions = (self._positions[first:] - self._positions[first]) * factor
        other._speeds = self._speeds[first:] * factor
        lengths = self._times[first:] - self._times[first]
        areas = self._integrals[first:] - self._integrals[first] - self._positions[first] * lengths
        other._integrals = areas * factor
        return other

    def forget(self, time: float) -> None:
        """Forget what no mean at a time or later needs."""
        first = int(np.searchsorted(self._times, time - self.ramp_time, side="right")) - 2
        if first > 0:
            self._times, self._positions, self._speeds, self._integrals = (
                one[first:] for one in (self._times, self._positions, self._speeds, self._integrals)
            )

    def at(self, times: Array) -> tuple[Array, Array, Array]:
        """Return position [m], speed [m/s] and acceleration [m/s^2] on the path at times (n,)."""
        late_position, late_speed, _, late_integral = self._raw(times)
        past = times - self.ramp_time
        position, speed, _, integral = self._raw(past)
        width = self.ramp_time
        return (
            self._origin + (late_integral - integral) / width,
            (late_position - position) / width,
            (late_speed - speed) / width,
        )

    def positions_before_mean(self, times: Array) -> Array:
        """Return positions [m] of the motion whose mean is the motion, at times (n,)."""
        return self._origin + self._raw(times)[0]

    def time_before_mean(self, position: float) -> float:
        """Return when the motion before the mean reaches a position [s]; infinity where it does not."""
        offset = position - self._origin
        index = int(np.searchsorted(self._positions, offset - 1e-12, side="left"))
        if index == 0:
            return float(self._times[0])
        if index >= len(self._positions):
            return math.inf
        return self._crossing(index - 1, offset)

    def _crossing(self, index: int, offset: float) -> float:
        """Return when the motion passes a position between two of its points."""
        way = offset - self._positions[index]
        whole = self._positions[index + 1] - self._positions[index]
        v0, v1 = self._speeds[index], self._speeds[index + 1]
        speed = math.sqrt(max(v0 * v0 + (v1 * v1 - v0 * v0) * way / whole, 0.0)) if whole > 0.0 else v0
        return float(self._times[index] + (2.0 * way / (v0 + speed) if v0 + speed > 0.0 else 0.0))

    def time_of(self, position: float) -> float:
        """Return when the motion reaches a position [s]; infinity where it does not."""
        early = self.time_before_mean(position)
        if math.isinf(early):
            return early
        low, high = early, min(early + self.ramp_time, self.end_time)
        for _ in range(60):
            middle = 0.5 * (low + high)
            if self.at(np.array([middle]))[0][0] < position - 1e-12:
                low = middle
            else:
                high = middle
        return high

    def _raw(self, times: Array) -> tuple[Array, Array, Array, Array]:
        """Return position, speed, acceleration and the integral of the position of the motion before the mean."""
        last = len(self._times) - 1
        index = np.clip(np.searchsorted(self._times, times, side="right") - 1, 0, last)
        after = np.minimum(index + 1, last)
        length = self._times[after] - self._times[index]
        inside = (length > 0.0) & (times >= self._times[0])
        acceleration = np.where(
            inside, (self._speeds[after] - self._speeds[index]) / np.where(length > 0.0, length, 1.0), 0.0
        )
        speed = np.where(inside, self._speeds[index], 0.0)
        dt = times - self._times[index]
        position = self._positions[index]
        return (
            position + speed * dt + acceleration * dt**2 / 2,
            speed + acceleration * dt,
            acceleration,
            self._integrals[index] + position * dt + speed * dt**2 / 2 + acceleration * dt**3 / 6,
        )
