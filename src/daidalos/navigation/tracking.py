"""Tracking of moving obstacles in laser scans: people, carts and other robots."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.navigation.costmap.observation import Observation

_MEASUREMENT_STD = 0.05
"""Deviation [m] of an object's centre: of its visible side, which changes."""

_ACCELERATION_STD = 0.5
"""Deviation [m/s^2] of what objects accelerate."""

_INITIAL_SPEED_STD = 1.5
"""Deviation [m/s] of the velocity of an object that was seen once."""

_MAX_SPEED = 3.0
"""Largest speed [m/s] of an object."""

_BACKGROUND = 0.15
"""Least distance [m] from an object's sides to what is seen beside it; it may be partly hidden otherwise."""


@dataclass
class Track:
    """Object that was seen in several scans.

    Attributes
    ----------
    state : ndarray, shape (4,)
        Position (x, y) [m] and velocity (x, y) [m/s].
    covariance : ndarray, shape (4, 4)
        Of the state.
    radius : float
        Half of its visible width [m].
    born, seen : float
        Times [s] of the first and the last scan that it was seen in.
    origin : ndarray, shape (2,)
        Where it was first seen [m].
    """

    state: Array
    covariance: Array
    radius: float
    born: float
    seen: float
    origin: Array = field(default_factory=lambda: np.zeros(2))

    @property
    def position(self) -> Array:
        """Where it is [m]; shape (2,)."""
        return self.state[:2]

    @property
    def velocity(self) -> Array:
        """How it moves [m/s]; shape (2,)."""
        return self.state[2:]

    def predict(self, transition: Array, noise: Array) -> None:
        """Move it on by a step of time; see `_constant_velocity`."""
        self.state = transition @ self.state
        self.covariance = transition @ self.covariance @ transition.T + noise

    def correct(self, centre: Array, radius: float, time: float) -> None:
        """Take a measurement of its centre (x, y) [m] in: the update of a Kalman filter."""
        observed = np.eye(2, 4)
        gain = self.covariance @ observed.T @ np.linalg.inv(self.covariance[:2, :2] + _MEASUREMENT_STD**2 * np.eye(2))
        self.state = self.state + gain @ (centre - self.state[:2])
        self.covariance = (np.eye(4) - gain @ observed) @ self.covariance
        self.radius = max(0.7 * self.radius + 0.3 * radius, radius)
        self.seen = time


class MovingObstacleTracker:
    """Tracker of small objects that stand free, by a Kalman filter of constant velocity each.

    An object is a run of neighbouring rays that end near to each other, no wider than a limit, with both sides nearer
    than what is seen beside them: what is partly hidden, such as a wall behind a pillar, seems to move as the sensor
    does. An object moves when its speed is above a limit and twice its own deviation, and it is away from where
    it was first seen.

    Parameters
    ----------
    max_width : float
        Largest width [m] of an object.
    min_speed : float
        Least speed [m/s] of a moving object.
    memory : float
        How long [s] an object is kept that is not seen.
    """

    def __init__(self, max_width: float = 1.0, min_speed: float = 0.25, memory: float = 0.6) -> None:
        self.max_width = max_width
        self.min_speed = min_speed
        self.memory = memory
        self.tracks: list[Track] = []
        self._time = -math.inf

    def reset(self) -> None:
        """Forget all objects."""
        self.tracks = []
        self._time = -math.inf

    def update(self, observation: Observation) -> None:
        """Take a scan in; one that is not later than the last is ignored, and time that is set back resets."""
        time = observation.stamp
        if time < self._time - self.memory:
            self.reset()
        if time <= self._time:
            return
        if self.tracks:
            transition, noise = _constant_velocity(time - self._time)
            for track in self.tracks:
                track.predict(transition, noise)
        step, self._time = time - self._time, time
        objects = free_standing(observation, self.max_width)
        self._associate(objects, time, step)
        self.tracks = [track for track in self.tracks if time - track.seen <= self.memory]

    def _associate(self, objects: list[tuple[Array, float]], time: float, step: float) -> None:
        """Correct each track by the nearest object, nearest pairs first, and begin tracks of what is left."""
        pairs = sorted(
            (float(np.hypot(*(centre - track.position))), number, index)
            for number, track in enumerate(self.tracks)
            for index, (centre, _) in enumerate(objects)
        )
        used_tracks: set[int] = set()
        used_objects: set[int] = set()
        for distance, number, index in pairs:
            track = self.tracks[number]
            spread = math.sqrt(float(track.covariance[0, 0] + track.covariance[1, 1])) + _MEASUREMENT_STD
            gate = min(3.0 * spread, _MAX_SPEED * min(step, self.memory) + 3.0 * _MEASUREMENT_STD)
            if distance > gate or number in used_tracks or index in used_objects:
                continue
            used_tracks.add(number)
            used_objects.add(index)
            track.correct(*objects[index], time)
        deviations = [_MEASUREMENT_STD, _MEASUREMENT_STD, _INITIAL_SPEED_STD, _INITIAL_SPEED_STD]
        for index, (centre, radius) in enumerate(objects):
            if index not in used_objects:
                state = np.concatenate([centre, np.zeros(2)])
                self.tracks.append(Track(state, np.diag(np.square(deviations)), radius, time, time, centre.copy()))

    def moving(self, now: float) -> list[Track]:
        """Return the objects that move, seen within the memory before a time [s]."""
        return [track for track in self.tracks if now - track.seen <= self.memory and self._moves(track)]

    def _moves(self, track: Track) -> bool:
        speed = float(np.hypot(*track.velocity))
        deviation = math.sqrt(float(max(track.covariance[2, 2], track.covariance[3, 3])))
        away = float(np.hypot(*(track.position - track.origin)))
        return speed > max(self.min_speed, 2.0 * deviation) and away > 4.0 * _MEASUREMENT_STD


def _constant_velocity(step: float) -> tuple[Array, Array]:
    """Return the transition of a state over a time [s], and the covariance that it adds; both (4, 4)."""
    transition = np.eye(4)
    transition[0, 2] = transition[1, 3] = step
    gain = np.array([[0.5 * step * step, 0.0, step, 0.0], [0.0, 0.5 * step * step, 0.0, step]]) * _ACCELERATION_STD
    return transition, gain.T @ gain


def free_standing(observation: Observation, max_width: float) -> list[tuple[Array, float]]:
    """Return centre (x, y) [m] and half of the width [m] of each object that stands free in a scan.

    Parameters
    ----------
    observation : Observation
        Rays in the order of their angles.
    max_width : float
        Largest width [m].
    """
    ends, hits = observation.ends, observation.hits
    count = ends.shape[0]
    if count < 3:
        return []
    ranges = np.hypot(*(ends - observation.origin).T)
    following = np.roll(np.arange(count), -1)
    gaps = np.hypot(*(ends[following] - ends).T)
    angle = 2.0 * math.pi / count
    joined = hits & hits[following] & (gaps < np.maximum(0.12, 3.0 * angle * np.minimum(ranges, ranges[following])))
    if joined.all():
        return []
    first = int(np.flatnonzero(~joined)[0]) + 1  # a run may go over the end of the scan
    order = np.roll(np.arange(count), -first)
    begins, stops = _runs(order, joined)
    first_rays, last_rays = order[begins], order[stops - 1]
    widths = np.hypot(*(ends[last_rays] - ends[first_rays]).T)
    is_object = hits[first_rays] & (widths <= max_width) & (stops - begins >= 2)
    is_object &= ranges[first_rays - 1] > ranges[first_rays] + _BACKGROUND
    is_object &= ranges[following[last_rays]] > ranges[last_rays] + _BACKGROUND
    found = []
    for begin, stop, width in zip(begins[is_object], stops[is_object], widths[is_object].tolist(), strict=True):
        points = ends[order[begin:stop]]
        centre = 0.5 * (points.min(axis=0) + points.max(axis=0))
        found.append((centre, max(0.5 * width, 0.05)))
    return found


def _runs(order: NDArray[np.intp], joined: NDArray[np.bool_]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return where the runs of joined rays begin in an order of rays, and the places after their ends.

    The last ray of the order is not joined with its next one.
    """
    stops = np.flatnonzero(~joined[order]) + 1
    return np.concatenate([[0], stops[:-1]]), stops
