"""Poses in the plane: arrays whose last axis is (x [m], y [m], yaw [rad]), composed as elements of SE(2)."""

import math

import numpy as np
from numpy.typing import ArrayLike

from daidalos.common.arrays import Array


def wrap(angle: ArrayLike) -> Array:
    """Wrap angles [rad] into [-pi, pi)."""
    return (np.asarray(angle, dtype=np.float64) + np.pi) % (2.0 * np.pi) - np.pi


def compose(first: ArrayLike, second: ArrayLike) -> Array:
    """Return the pose of C in A from the pose of B in A and the pose of C in B; the leading axes broadcast."""
    a = np.asarray(first, dtype=np.float64)
    b = np.asarray(second, dtype=np.float64)
    cosine, sine = np.cos(a[..., 2]), np.sin(a[..., 2])
    x = a[..., 0] + cosine * b[..., 0] - sine * b[..., 1]
    y = a[..., 1] + sine * b[..., 0] + cosine * b[..., 1]
    return np.stack([x, y, wrap(a[..., 2] + b[..., 2])], axis=-1)


def between(first: ArrayLike, second: ArrayLike) -> Array:
    """Return the pose of B in A from the poses of A and B in one frame; the leading axes broadcast."""
    a = np.asarray(first, dtype=np.float64)
    b = np.asarray(second, dtype=np.float64)
    cosine, sine = np.cos(a[..., 2]), np.sin(a[..., 2])
    dx, dy = b[..., 0] - a[..., 0], b[..., 1] - a[..., 1]
    x = cosine * dx + sine * dy
    y = -sine * dx + cosine * dy
    return np.stack([x, y, wrap(b[..., 2] - a[..., 2])], axis=-1)


def inverse(pose: ArrayLike) -> Array:
    """Return the pose of A in B from the pose of B in A."""
    return between(pose, np.zeros(3))


def transform_points(pose: ArrayLike, points: Array) -> Array:
    """Return points (n, 2) of the frame of a pose in the frame that the pose is given in [m]."""
    x, y, yaw = (float(value) for value in np.asarray(pose, dtype=np.float64))
    cosine, sine = np.cos(yaw), np.sin(yaw)
    rotation = np.array([[cosine, -sine], [sine, cosine]])
    moved: Array = points @ rotation.T + (x, y)
    return moved


def interpolate(start: ArrayLike, end: ArrayLike, share: ArrayLike) -> Array:
    """Return the pose on the straight line from start (share 0) to end (share 1), with yaw along the shorter arc."""
    a = np.asarray(start, dtype=np.float64)
    b = np.asarray(end, dtype=np.float64)
    s = np.asarray(share, dtype=np.float64)[..., None]
    step = b - a
    step[..., 2] = wrap(step[..., 2])
    between_them = a + s * step
    between_them[..., 2] = wrap(between_them[..., 2])
    return between_them


def move_along_arc(pose: ArrayLike, forward: float, turn: float, sideways: float = 0.0) -> Array:
    """Return the pose after a motion with constant velocity in the body's frame; its yaw is not wrapped.

    Parameters
    ----------
    pose : array_like, shape (3,)
    forward, sideways : float
        Travel along the body's x and y axis over the arc [m].
    turn : float
        Change of heading over the arc [rad].
    """
    x, y, yaw = (float(value) for value in np.asarray(pose, dtype=np.float64))
    half = turn / 2
    chord = math.sin(half) / half if abs(half) > 1e-9 else 1.0
    cosine, sine = math.cos(yaw + half), math.sin(yaw + half)
    dx = chord * (forward * cosine - sideways * sine)
    dy = chord * (forward * sine + sideways * cosine)
    return np.array((x + dx, y + dy, yaw + turn))
