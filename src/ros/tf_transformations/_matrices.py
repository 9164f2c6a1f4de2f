"""Making homogeneous 4 x 4 matrices, and combining them.

A matrix M takes the point (x, y, z, 1), as a column, to M times it. Points may be given with three or four
coordinates.
"""

from __future__ import annotations

from math import cos, radians, sin, sqrt, tan

import numpy as np
from numpy.typing import ArrayLike

from ._vectors import EPSILON, Array, direction_of


def identity_matrix() -> Array:
    """Return the matrix that changes nothing."""
    return np.identity(4)


def translation_matrix(direction: ArrayLike) -> Array:
    """Return the matrix that moves by a vector."""
    return _affine(np.identity(3), _xyz(direction))


def translation_from_matrix(matrix: ArrayLike) -> Array:
    """Return the vector by which a matrix moves."""
    return np.array(matrix, dtype=np.float64)[:3, 3].copy()


def reflection_matrix(point: ArrayLike, normal: ArrayLike) -> Array:
    """Return the matrix that mirrors at the plane through `point` with the given normal."""
    n = direction_of(normal)
    return _affine(np.identity(3) - 2.0 * np.outer(n, n), 2.0 * (_xyz(point) @ n) * n)


def rotation_matrix(angle: float, direction: ArrayLike, point: ArrayLike | None = None) -> Array:
    """Return the matrix that turns about an axis.

    Parameters
    ----------
    angle
        In radians.
    direction
        Of the axis.
    point
        On the axis; the origin where None.
    """
    axis = direction_of(direction)
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    rotation = np.identity(3) + sin(angle) * cross + (1.0 - cos(angle)) * (cross @ cross)
    return _about(rotation, point)


def scale_matrix(factor: float, origin: ArrayLike | None = None, direction: ArrayLike | None = None) -> Array:
    """Return the matrix that scales about a point.

    Parameters
    ----------
    factor
        Minus one mirrors at the point.
    origin
        The point that stays; the origin where None.
    direction
        The only direction to scale along; all where None.
    """
    if direction is None:
        return _about(factor * np.identity(3), origin)
    d = direction_of(direction)
    return _about(np.identity(3) + (factor - 1.0) * np.outer(d, d), origin)


def projection_matrix(
    point: ArrayLike,
    normal: ArrayLike,
    direction: ArrayLike | None = None,
    perspective: ArrayLike | None = None,
    pseudo: bool = False,
) -> Array:
    """Return the matrix that projects onto a plane.

    Parameters
    ----------
    point, normal
        Of the plane.
    direction
        Along which to project; the normal where None.
    perspective
        The eye, for a central projection.
    pseudo
        Whether a central projection keeps the order of depths.
    """
    n = direction_of(normal)
    distance = float(_xyz(point) @ n)
    if perspective is None:
        d = n if direction is None else _xyz(direction)
        d = d / (d @ n)
        return _affine(np.identity(3) - np.outer(d, n), distance * d)
    eye = _xyz(perspective)
    shift = eye + n if pseudo else eye
    matrix = np.empty((4, 4))
    matrix[:3, :3] = (eye @ n - distance) * np.identity(3) - np.outer(shift, n)
    matrix[:3, 3] = distance * shift
    matrix[3, :3] = -n
    matrix[3, 3] = eye @ n
    return matrix


def clip_matrix(
    left: float, right: float, bottom: float, top: float, near: float, far: float, perspective: bool = False
) -> Array:
    """Return the matrix that takes a frustum to the cube from -1 to 1.

    Parameters
    ----------
    left, right, bottom, top, near, far
        Bounds of the frustum along x, y and z; those of x and y at the near plane when it is a perspective one.
    perspective
        Whether the frustum is a pyramid with its tip at the origin (divide by the fourth coordinate), or a box.

    Raises
    ------
    ValueError
        When a lower bound is not below the upper one, or a perspective frustum does not begin before the eye.
    """
    if left >= right or bottom >= top or near >= far:
        raise ValueError(f"invalid frustum: {(left, right, bottom, top, near, far)} must be three rising pairs")
    low, high = np.array([left, bottom, near], dtype=float), np.array([right, top, far], dtype=float)
    middle, half = (low + high) / 2.0, (high - low) / 2.0
    if not perspective:
        return _affine(np.diag(1.0 / half), -middle / half)
    if near <= EPSILON:
        raise ValueError(f"invalid frustum: near must be positive, not {near}")
    matrix = np.zeros((4, 4))
    matrix[0, 0], matrix[1, 1] = -near / half[0], -near / half[1]
    matrix[:3, 2] = middle / half * (1.0, 1.0, -1.0)
    matrix[2, 3] = near * far / half[2]
    matrix[3, 2] = -1.0
    return matrix


def shear_matrix(angle: float, direction: ArrayLike, point: ArrayLike, normal: ArrayLike) -> Array:
    """Return the matrix that shears: what lies above a plane is pushed along it.

    Parameters
    ----------
    angle
        By which the normal leans over, in radians.
    direction
        To push in; perpendicular to the normal.
    point, normal
        Of the plane.

    Raises
    ------
    ValueError
        When the direction leaves the plane.
    """
    d, n = direction_of(direction), direction_of(normal)
    if abs(d @ n) > 1e-6:
        raise ValueError("direction and normal vectors are not orthogonal")
    push = tan(angle) * d
    return _affine(np.identity(3) + np.outer(push, n), -(_xyz(point) @ n) * push)


def orthogonalization_matrix(lengths: ArrayLike, angles: ArrayLike) -> Array:
    """Return the matrix that takes coordinates along the edges of a crystal's cell to Cartesian ones.

    Parameters
    ----------
    lengths
        Of the edges a, b and c.
    angles
        Between b and c, c and a, a and b, in degrees. Edge c lies on z, and b in the plane of y and z.
    """
    a, b, c = (float(value) for value in np.asarray(lengths))
    alpha, beta, gamma = (radians(value) for value in np.asarray(angles))
    a_z, b_z = a * cos(beta), b * cos(alpha)
    b_y = b * sin(alpha)
    a_y = (a * b * cos(gamma) - a_z * b_z) / b_y
    a_x = sqrt(a * a - a_y * a_y - a_z * a_z)
    return _affine(np.array([[a_x, 0.0, 0.0], [a_y, b_y, 0.0], [a_z, b_z, c]]), np.zeros(3))


def inverse_matrix(matrix: ArrayLike) -> Array:
    """Return the matrix that undoes another."""
    return np.linalg.inv(np.asarray(matrix, dtype=np.float64))


def concatenate_matrices(*matrices: ArrayLike) -> Array:
    """Return the product of matrices: the last one acts first."""
    result = np.identity(4)
    for matrix in matrices:
        result = result @ np.asarray(matrix, dtype=np.float64)
    return result


def is_same_transform(matrix0: ArrayLike, matrix1: ArrayLike) -> bool:
    """Tell whether two matrices do the same to points, up to rounding."""
    one, two = np.array(matrix0, dtype=np.float64), np.array(matrix1, dtype=np.float64)
    return bool(np.allclose(one / one[3, 3], two / two[3, 3]))


def _affine(linear: Array, shift: Array) -> Array:
    matrix = np.identity(4)
    matrix[:3, :3] = linear
    matrix[:3, 3] = shift
    return matrix


def _about(linear: Array, point: ArrayLike | None) -> Array:
    """Return the matrix of a linear map that leaves a point where it is."""
    if point is None:
        return _affine(linear, np.zeros(3))
    fixed = _xyz(point)
    return _affine(linear, fixed - linear @ fixed)


def _xyz(point: ArrayLike) -> Array:
    return np.asarray(point, dtype=np.float64)[:3]
