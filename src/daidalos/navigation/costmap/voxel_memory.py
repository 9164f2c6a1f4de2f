"""Voxels with the time at which each was last seen, and what makes them fade.

S. Macenski, D. Tsai and M. Feinberg, Spatio-temporal voxel layer: a view on robot perception for the dynamic world
(2020).
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array

LINEAR, EXPONENTIAL, PERSISTENT = 0, 1, -1
DEPTH_CAMERA, LIDAR = 0, 1
_BITS = 21
_HALF = 1 << (_BITS - 1)


@dataclass(frozen=True)
class View:
    """Part of space that a sensor sees, in which voxels that are not seen again fade sooner.

    Attributes
    ----------
    kind : int
        `DEPTH_CAMERA`, which looks along its z axis with x to the right, or `LIDAR`, whose z axis is up.
    position : ndarray, shape (3,)
        Of the sensor [m].
    rotation : ndarray, shape (3, 3)
        Its axes as columns.
    nearest, farthest : float
        Distances [m]: along the axis of a camera, from the axis of a lidar.
    vertical, horizontal : float
        Whole angles [rad].
    padding : float
        Added on both sides of a lidar's vertical angle [m].
    acceleration : float
        How much sooner voxels fade: its sixth times the cube of their age [1/s^2].
    """

    kind: int
    position: Array
    rotation: Array
    nearest: float
    farthest: float
    vertical: float
    horizontal: float
    padding: float
    acceleration: float

    def contains(self, points: Array) -> NDArray[np.bool_]:
        """Return which points (n, 3) are in it."""
        x, y, z = ((points - self.position) @ self.rotation).T
        if self.kind == DEPTH_CAMERA:
            wide, high = math.tan(0.5 * self.horizontal), math.tan(0.5 * self.vertical)
            seen = (z >= self.nearest) & (z <= self.farthest) & (np.abs(x) <= wide * z) & (np.abs(y) <= high * z)
        else:
            away = np.hypot(x, y)
            high = math.tan(min(0.5 * self.vertical, 0.5 * math.pi - 1e-6))
            seen = (away >= self.nearest) & (away <= self.farthest) & (np.abs(z) <= high * away + self.padding)
            seen &= np.abs(np.arctan2(y, x)) <= 0.5 * self.horizontal + 1e-9
        return np.asarray(seen)


class VoxelMemory:
    """Voxels of space, each with the time [s] at which it was seen.

    Parameters
    ----------
    size : float
        Edge of a voxel [m].
    """

    def __init__(self, size: float) -> None:
        self.size = size
        self._keys = np.zeros(0, np.int64)
        self.times = np.zeros(0)

    @property
    def centres(self) -> Array:
        """Centres (n, 3) of the voxels [m]."""
        mask = (1 << _BITS) - 1
        levels = np.stack([(self._keys >> (shift * _BITS)) & mask for shift in (2, 1, 0)], axis=-1)
        return np.asarray((levels - _HALF + 0.5) * self.size)

    def mark(self, points: Array, time: float) -> None:
        """Mark the voxels of points (n, 3), seen at a time [s]; points farther than a million voxels are left out."""
        levels = np.floor(points / self.size)
        levels = levels[(np.abs(levels) < _HALF).all(axis=1)].astype(np.int64) + _HALF
        keys = (levels[:, 0] << (2 * _BITS)) | (levels[:, 1] << _BITS) | levels[:, 2]
        every = np.concatenate([self._keys, keys])
        times = np.concatenate([self.times, np.full(keys.size, time)])
        self._keys, index = np.unique(every, return_inverse=True)
        self.times = np.full(self._keys.size, -np.inf)
        np.maximum.at(self.times, index, times)

    def keep(self, kept: NDArray[np.bool_]) -> None:
        """Forget the other voxels."""
        self._keys, self.times = self._keys[kept], self.times[kept]

    def fade(self, now: float, model: int, duration: float, views: Iterable[View]) -> None:
        """Forget what is too old, and what a sensor no longer sees though it looks there.

        Parameters
        ----------
        now : float
            Time [s].
        model : int
            `LINEAR`: a voxel stays for `duration` [s]. `EXPONENTIAL`: what it has left is the duration times exp(-age),
            so that it fades in views alone. `PERSISTENT`: it has the duration left all the time.
        duration : float
            Negative for ever.
        views : iterable of View
            Of the sensors that clear; a voxel is in the first one that holds it.
        """
        age = np.maximum(now - self.times, 0.0)
        left = np.full(age.size, np.inf if duration < 0.0 else duration)
        if duration >= 0.0 and model == LINEAR:
            left -= age
        elif duration >= 0.0 and model == EXPONENTIAL:
            left *= np.exp(-age)
        centres = self.centres
        sooner, unseen = np.zeros(age.size), np.ones(age.size, np.bool_)
        for view in views:
            held = unseen & view.contains(centres)
            sooner[held] = view.acceleration * age[held] ** 3 / 6.0
            unseen &= ~held
        self.times = self.times - sooner
        self.keep(left - sooner >= 0.0)
