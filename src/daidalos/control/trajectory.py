"""Joint trajectories through waypoints: polynomials of the degree that the waypoints' derivatives determine."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from daidalos.common.arrays import Array
from daidalos.samples.controllers import TrajectoryPoint


class Trajectory:
    """Piecewise polynomials through waypoints.

    Between two waypoints that give positions alone the motion is linear; with velocities cubic, with accelerations
    as well quintic: as smooth as what is given at both ends. After the last waypoint everything rests there.

    Parameters
    ----------
    times : array (k,)
        Ascending [s].
    positions : array (k, n)
        [rad, m].
    velocities, accelerations : array (k, n)
        NaN where they are not given.
    steps : bool
        Stay at each waypoint until the next one instead.
    keep_velocity : bool
        Report the last waypoint's velocity, and no rest, after the end.
    """

    def __init__(
        self,
        times: Array,
        positions: Array,
        velocities: Array | None = None,
        accelerations: Array | None = None,
        steps: bool = False,
        keep_velocity: bool = False,
    ) -> None:
        self.times = np.asarray(times, dtype=np.float64)
        self.positions = np.asarray(positions, dtype=np.float64)
        unknown = np.full_like(self.positions, np.nan)
        self.velocities = unknown if velocities is None else velocities
        self.accelerations = unknown if accelerations is None else accelerations
        self._last_velocity = np.nan_to_num(self.velocities[-1]) if keep_velocity else np.zeros(self.positions.shape[1])
        self._coefficients = self._steps() if steps else self._splines()

    @property
    def duration(self) -> float:
        """Time of the last waypoint [s]."""
        return float(self.times[-1])

    def sample(self, time: float) -> tuple[Array, Array, Array]:
        """Return positions, velocities and accelerations (n,) at a time; before the start it rests there."""
        count = self.positions.shape[1]
        if time >= self.times[-1]:
            return self.positions[-1].copy(), self._last_velocity.copy(), np.zeros(count)
        if time < self.times[0]:
            return self.positions[0].copy(), np.zeros(count), np.zeros(count)
        segment = int(np.searchsorted(self.times, time, side="right")) - 1
        t = time - self.times[segment]
        c0, c1, c2, c3, c4, c5 = self._coefficients[segment]
        position = c0 + t * (c1 + t * (c2 + t * (c3 + t * (c4 + t * c5))))
        velocity = c1 + t * (2 * c2 + t * (3 * c3 + t * (4 * c4 + t * 5 * c5)))
        acceleration = 2 * c2 + t * (6 * c3 + t * (12 * c4 + t * 20 * c5))
        return position, velocity, acceleration

    def shifted(self, offset: Array) -> Trajectory:
        """Return the same motion with positions moved by `offset` (n,)."""
        result = object.__new__(Trajectory)
        result.__dict__.update(self.__dict__)
        result.positions = self.positions + offset
        result._coefficients = self._coefficients.copy()
        result._coefficients[:, 0] += offset
        return result

    def _steps(self) -> Array:
        coefficients = np.zeros((len(self.times) - 1, 6, self.positions.shape[1]))
        coefficients[:, 0] = self.positions[:-1]
        return coefficients

    def _splines(self) -> Array:
        """Return coefficients (k - 1, 6, n), rising powers of the time since each segment's start."""
        p0, p1 = self.positions[:-1], self.positions[1:]
        v0, v1 = self.velocities[:-1], self.velocities[1:]
        a0, a1 = self.accelerations[:-1], self.accelerations[1:]
        d = np.diff(self.times)[:, None]
        linear = np.stack([p0, (p1 - p0) / d, *[np.zeros_like(p0)] * 4], axis=1)
        slope = (p1 - p0) / d
        cubic = np.stack(
            [p0, v0, (3 * slope - 2 * v0 - v1) / d, (v0 + v1 - 2 * slope) / d**2, *[np.zeros_like(p0)] * 2], axis=1
        )
        quintic = np.stack(
            [
                p0,
                v0,
                a0 / 2,
                (20 * slope - 8 * v1 - 12 * v0 - (3 * a0 - a1) * d) / (2 * d**2),
                (-30 * slope + 14 * v1 + 16 * v0 + (3 * a0 - 2 * a1) * d) / (2 * d**3),
                (12 * slope - 6 * (v1 + v0) - (a0 - a1) * d) / (2 * d**4),
            ],
            axis=1,
        )
        best = np.where(np.isnan(quintic).any(axis=(1, 2), keepdims=True), cubic, quintic)
        return np.where(np.isnan(best).any(axis=(1, 2), keepdims=True), linear, best)


def waypoints(points: Sequence[TrajectoryPoint], count: int) -> tuple[Array, Array, Array, Array]:
    """Return times (k,), positions, velocities and accelerations (k, n) of points; NaN where not given."""

    def rows(name: str) -> Array:
        unknown = np.full(count, np.nan)
        values = [getattr(point, name) for point in points]
        return np.array([unknown if one is None else one for one in values], dtype=np.float64).reshape(-1, count)

    times = np.array([point.time for point in points])
    return times, rows("positions"), rows("velocities"), rows("accelerations")


def integrated(times: Array, velocities: Array, start: Array) -> Array:
    """Return positions (k, n) at the times, from a start (n,) at time 0 by velocities, with the trapezium rule."""
    durations = np.diff(times, prepend=0.0)[:, None]
    before = np.vstack((np.zeros_like(velocities[:1]), velocities[:-1]))
    return start + np.cumsum(durations * (before + velocities) / 2, axis=0)
