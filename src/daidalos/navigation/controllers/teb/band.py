"""Timed elastic band: poses and the times between them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.pose2 import wrap
from daidalos.navigation.controllers.teb.optimization import SHORTEST_TIME

_LOOKED_AT = 10
"""Number of poses at the start among which the one that the robot has come to is looked for."""


@dataclass
class Band:
    """A trajectory that is optimised from cycle to cycle.

    Attributes
    ----------
    poses : ndarray, shape (n, 3)
        Poses (x, y, yaw) in the costmap's frame.
    times : ndarray, shape (n - 1,)
        Times [s] between them.
    cost : float
        By the last optimisation.
    """

    poses: Array
    times: Array
    cost: float = math.inf

    @classmethod
    def along(
        cls, path: Array, speed: float, turn_rate: float, least: int, *, backward: bool = False, sideways: bool = False
    ) -> Band:
        """Return a band along a path.

        Parameters
        ----------
        path : ndarray, shape (n, 3)
            Poses from the robot's to the goal's; those between look along the path.
        speed, turn_rate : float
            By which the times are chosen [m/s, rad/s].
        least : int
            Number of poses at least.
        backward : bool
            Whether the robot goes backwards where the path leads behind it.
        sideways : bool
            Whether it turns evenly on the way, rather than to look along it.
        """
        steps = np.diff(path[:, :2], axis=0)
        kept = np.concatenate([[True], np.hypot(*steps.T) > 1e-6])
        kept[-1] = True
        poses = path[kept].copy()
        if poses.shape[0] < max(least, 2):
            poses = _between(path[0], path[-1], max(least, 2))
        if math.hypot(*(path[-1] - path[0])[:2]) > 1e-3 or poses.shape[0] > max(least, 2):  # no turn on the spot
            headings = np.arctan2(*np.diff(poses[:, :2], axis=0).T[::-1])
            poses[1:-1, 2] = headings[1:] + (math.pi if backward else 0.0)
        if sideways:
            turn = float(wrap(path[-1, 2] - path[0, 2]))
            poses[:, 2] = path[0, 2] + np.linspace(0.0, turn, poses.shape[0])
        poses[:, 2] = np.unwrap(poses[:, 2])
        return cls(poses, _times_of(poses, speed, turn_rate))

    def follow(self, start: Array, goal: Array) -> None:
        """Drop the poses that the robot has passed, and move the ends."""
        looked_at = self.poses[: min(_LOOKED_AT, self.poses.shape[0] - 2)]
        if looked_at.shape[0]:
            nearest = int(np.hypot(*(looked_at - start)[:, :2].T).argmin())
            self.poses, self.times = self.poses[nearest:], self.times[nearest:]
        self.poses[0] = start
        self.poses[-1] = goal
        self.poses[:, 2] = np.unwrap(self.poses[:, 2])

    def resize(self, time: float, hysteresis: float, least: int, most: int) -> None:
        """Insert and remove poses until the times are near to `time` [s], within `hysteresis` [s]."""
        poses, times = list(self.poses), list(self.times)
        for _ in range(100):
            changed = False
            k = 0
            while k < len(times):
                if times[k] > time + hysteresis and len(poses) < most:
                    poses.insert(k + 1, _middle(poses[k], poses[k + 1]))
                    times[k : k + 1] = [0.5 * times[k], 0.5 * times[k]]
                    changed = True
                    k += 2
                elif times[k] < time - hysteresis and len(poses) > max(least, 3):
                    if k < len(times) - 1:
                        times[k : k + 2] = [times[k] + times[k + 1]]
                        del poses[k + 1]
                    else:
                        times[k - 1 : k + 1] = [times[k - 1] + times[k]]
                        del poses[k]
                    changed = True
                    k += 1
                else:
                    k += 1
            if not changed:
                break
        self.poses, self.times = np.array(poses), np.array(times)

    def velocity(self, ahead: int, *, exact: bool) -> Array:
        """Return the velocity (x, y, yaw) of the first `ahead` steps together, in the frame of the first pose."""
        last = min(max(ahead, 1), self.times.size)
        duration = float(self.times[:last].sum())
        turn = float(wrap(self.poses[last, 2] - self.poses[0, 2]))
        dx, dy = self.poses[last, :2] - self.poses[0, :2]
        middle = float(self.poses[0, 2]) + 0.5 * turn
        stretch = 0.5 * turn / math.sin(0.5 * turn) if exact and abs(turn) > 1e-4 else 1.0
        forward = math.cos(middle) * dx + math.sin(middle) * dy
        left = math.cos(middle) * dy - math.sin(middle) * dx
        return np.array([stretch * forward, stretch * left, turn]) / duration


def _between(start: Array, goal: Array, count: int) -> Array:
    shares = np.linspace(0.0, 1.0, count)[:, None]
    poses = start + shares * (goal - start)
    poses[:, 2] = start[2] + shares[:, 0] * float(wrap(goal[2] - start[2]))
    return poses


def _middle(one: Array, other: Array) -> Array:
    middle = 0.5 * (one + other)
    middle[2] = one[2] + 0.5 * float(wrap(other[2] - one[2]))
    return middle


def _times_of(poses: Array, speed: float, turn_rate: float) -> Array:
    steps = np.diff(poses, axis=0)
    times = np.maximum(np.hypot(steps[:, 0], steps[:, 1]) / speed, np.abs(wrap(steps[:, 2])) / turn_rate)
    return np.maximum(times, 10 * SHORTEST_TIME)
