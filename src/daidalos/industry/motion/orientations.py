"""Orientations over arrays: quaternions (..., 4) as x, y, z, w."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daidalos.industry.motion.orientation_kernels import multiply_kernel, slerp_kernel

Array = NDArray[np.float64]


def multiply(left: Array, right: Array) -> Array:
    """Return the products of quaternions (n, 4) or (4,)."""
    a, b = _rows(left), _rows(right)
    out = np.empty((max(len(a), len(b)), 4))
    multiply_kernel(a, b, out)
    return out if left.ndim > 1 or right.ndim > 1 else out.reshape(4)


def _rows(q: Array) -> Array:
    return np.ascontiguousarray(q, dtype=np.float64).reshape(-1, 4)


def conjugate(q: Array) -> Array:
    """Return the inverses of unit quaternions."""
    return np.asarray(q * np.array([-1.0, -1.0, -1.0, 1.0]))


def rotation_vectors(q: Array) -> Array:
    """Return the shortest rotation vectors (..., 3) [rad] of unit quaternions."""
    q = np.where(q[..., 3:] < 0.0, -q, q)
    sine = np.linalg.norm(q[..., :3], axis=-1, keepdims=True)
    angle = 2.0 * np.arctan2(sine, q[..., 3:])
    return q[..., :3] * np.where(sine > 1e-12, angle / np.maximum(sine, 1e-12), 2.0)


def from_rotation_vectors(vectors: Array) -> Array:
    """Return the unit quaternions of rotation vectors (..., 3) [rad]."""
    half = 0.5 * np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.concatenate([0.5 * vectors * np.sinc(half / np.pi), np.cos(half)], axis=-1)


def slerp(start: Array, end: Array, shares: Array) -> Array:
    """Return orientations between, or beyond, two: one per share, along the shorter rotation.

    Parameters
    ----------
    start, end : arrays of shape (4,) or (n, 4)
        Orientations at the shares 0 and 1.
    shares : array of shape (n,)
        Positions on the rotation.
    """
    out = np.empty((len(shares), 4))
    slerp_kernel(_rows(start), _rows(end), shares, out)
    return out


def matrices(q: Array) -> Array:
    """Return the rotation matrices (n, 3, 3) of unit quaternions (n, 4)."""
    x, y, z, w = q.T
    return np.stack(
        [
            np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)], axis=-1),
            np.stack([2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)], axis=-1),
            np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], axis=-1),
        ],
        axis=-2,
    )


def continuous(q: Array) -> Array:
    """Return quaternions (n, 4) with the signs for which neighbours are alike."""
    flips = np.sum(q[1:] * q[:-1], axis=-1) < 0.0
    signs = np.concatenate([[1.0], np.cumprod(np.where(flips, -1.0, 1.0))])
    return np.asarray(q * signs[:, None])
