"""Quaternions (x, y, z, w)."""

from __future__ import annotations

from math import acos, cos, pi, sin, sqrt

import numpy as np
from numpy.typing import ArrayLike

from ._vectors import EPSILON, Array, random_vector, unit_vector


def quaternion_about_axis(angle: float, axis: ArrayLike) -> Array:
    """Return the quaternion of a rotation by an angle in radians about an axis."""
    x, y, z = (float(value) for value in np.asarray(axis)[:3])
    length = sqrt(x * x + y * y + z * z)
    scale = sin(angle / 2.0) / length if length > EPSILON else 1.0
    return np.array([x * scale, y * scale, z * scale, cos(angle / 2.0)])


def quaternion_matrix(quaternion: ArrayLike) -> Array:
    """Return the homogeneous matrix of the rotation; the quaternion may have any length."""
    x, y, z, w = (float(value) for value in np.asarray(quaternion)[:4])
    squared = x * x + y * y + z * z + w * w
    matrix = np.identity(4)
    if squared < EPSILON:
        return matrix
    s = 2.0 / squared
    matrix[:3, :3] = (
        (1.0 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)),
        (s * (x * y + z * w), 1.0 - s * (x * x + z * z), s * (y * z - x * w)),
        (s * (x * z - y * w), s * (y * z + x * w), 1.0 - s * (x * x + y * y)),
    )
    return matrix


def quaternion_from_matrix(matrix: ArrayLike) -> Array:
    """Return the quaternion, with w not negative, of the rotation of a matrix (3 x 3 or 4 x 4)."""
    m = np.asarray(matrix, dtype=np.float64)[:3, :3]
    xx, yy, zz = m.diagonal()
    # Four times the products of the components; the row of the largest one loses no digits (Shepperd, 1978).
    products = np.array(
        [
            [1.0 + xx - yy - zz, m[1, 0] + m[0, 1], m[0, 2] + m[2, 0], m[2, 1] - m[1, 2]],
            [m[1, 0] + m[0, 1], 1.0 - xx + yy - zz, m[2, 1] + m[1, 2], m[0, 2] - m[2, 0]],
            [m[0, 2] + m[2, 0], m[2, 1] + m[1, 2], 1.0 - xx - yy + zz, m[1, 0] - m[0, 1]],
            [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], 1.0 + xx + yy + zz],
        ]
    )
    result: Array = unit_vector(products[np.argmax(products.diagonal())])
    return -result if result[3] < 0.0 else result


def quaternion_multiply(quaternion1: ArrayLike, quaternion0: ArrayLike) -> Array:
    """Return the product: the rotation `quaternion0`, then `quaternion1`."""
    a, b, c, d = np.asarray(quaternion1)
    e, f, g, h = np.asarray(quaternion0)
    return np.array(
        [
            d * e + a * h + b * g - c * f,
            d * f + b * h + c * e - a * g,
            d * g + c * h + a * f - b * e,
            d * h - a * e - b * f - c * g,
        ],
        dtype=np.float64,
    )


def quaternion_conjugate(quaternion: ArrayLike) -> Array:
    """Return the quaternion with the opposite axis."""
    return np.asarray(quaternion, dtype=np.float64) * (-1.0, -1.0, -1.0, 1.0)


def quaternion_inverse(quaternion: ArrayLike) -> Array:
    """Return the quaternion whose product with this one is (0, 0, 0, 1)."""
    values = np.asarray(quaternion, dtype=np.float64)
    return quaternion_conjugate(values) / (values @ values)


def quaternion_slerp(
    quat0: ArrayLike, quat1: ArrayLike, fraction: float, spin: int = 0, shortestpath: bool = True
) -> Array:
    """Return the rotation on the arc from one to another (Shoemake, 1985).

    Parameters
    ----------
    quat0, quat1
        Both ends.
    fraction
        How far: 0 at the first end, 1 at the other; beyond them the motion goes on.
    spin
        How many half turns to add.
    shortestpath
        Whether to take the shorter of the two arcs.
    """
    one, two = unit_vector(quat0), unit_vector(quat1)
    if fraction == 0.0:
        return one  # type: ignore[no-any-return]
    if fraction == 1.0:
        return two  # type: ignore[no-any-return]
    dot = max(-1.0, min(float(one @ two), 1.0))
    if abs(abs(dot) - 1.0) < EPSILON:
        return one  # type: ignore[no-any-return]
    if shortestpath and dot < 0.0:
        dot, two = -dot, -two
    between = acos(dot)
    travelled = fraction * (between + spin * pi)
    result: Array = (sin(between - travelled) * one + sin(travelled) * two) / sin(between)
    return result


def random_quaternion(rand: ArrayLike | None = None) -> Array:
    """Return a random rotation, all of them equally likely (Shoemake, 1992).

    Parameters
    ----------
    rand
        Three numbers from 0 up to 1 that decide it; random ones where None.
    """
    u, v, w = (float(value) for value in (random_vector(3) if rand is None else np.asarray(rand)))
    low, high = sqrt(1.0 - u), sqrt(u)
    v, w = 2.0 * pi * v, 2.0 * pi * w
    return np.array([sin(v) * low, cos(v) * low, sin(w) * high, cos(w) * high])


def random_rotation_matrix(rand: ArrayLike | None = None) -> Array:
    """Return the matrix of a random rotation; see `random_quaternion`."""
    return quaternion_matrix(random_quaternion(rand))
