"""What a homogeneous 4 x 4 matrix does: the inverse of the functions that make them."""

from __future__ import annotations

from math import atan, atan2
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ._euler import euler_from_matrix, euler_matrix
from ._quaternions import quaternion_matrix
from ._vectors import EPSILON, Array, homogeneous, unit_vector

_TOLERANCE = 1e-8


def reflection_from_matrix(matrix: ArrayLike) -> tuple[Array, Array]:
    """Return a point (four coordinates) and the normal of the plane that a matrix mirrors at.

    Raises
    ------
    ValueError
        When it is no reflection.
    """
    linear, shift = _split(matrix)
    # I - M = 2 n n^T: any column that is not zero shows the normal.
    normal = _leading(np.identity(3) - linear)
    _require(np.allclose(linear, np.identity(3) - 2.0 * np.outer(normal, normal)), "the matrix is no reflection")
    return homogeneous(_fixed_point(linear, shift)), normal


def rotation_from_matrix(matrix: ArrayLike) -> tuple[float, Array, Array]:
    """Return the angle in radians, the direction of the axis and a point on it (four coordinates).

    Raises
    ------
    ValueError
        When it is no rotation.
    """
    linear, shift = _split(matrix)
    _require(
        np.allclose(linear @ linear.T, np.identity(3), atol=1e-6) and np.linalg.det(linear) > 0.0,
        "the matrix is no rotation",
    )
    twice_sine = np.array([linear[2, 1] - linear[1, 2], linear[0, 2] - linear[2, 0], linear[1, 0] - linear[0, 1]])
    # The axis is what I - R takes to zero; its sign, where the angle shows one, is that of a positive angle.
    axis = np.linalg.svd(np.identity(3) - linear)[2][2]
    if axis @ twice_sine < 0.0:
        axis = -axis
    angle = atan2(axis @ twice_sine, np.trace(linear) - 1.0)
    return angle, axis, homogeneous(_fixed_point(linear, shift))


def scale_from_matrix(matrix: ArrayLike) -> tuple[float, Array, Array | None]:
    """Return the factor, the point that stays (four coordinates) and the direction (None: all).

    Raises
    ------
    ValueError
        When it is no scaling.
    """
    linear, shift = _split(matrix)
    if np.allclose(linear, linear[0, 0] * np.identity(3)):
        factor, direction = float(linear[0, 0]), None
    else:
        factor = float(np.trace(linear) - 2.0)
        direction = _leading(linear - np.identity(3))
        scaling = np.identity(3) + (factor - 1.0) * np.outer(direction, direction)
        _require(np.allclose(linear, scaling), "the matrix is no scaling")
    return factor, homogeneous(_fixed_point(linear, shift)), direction


def projection_from_matrix(
    matrix: ArrayLike, pseudo: bool = False
) -> tuple[Array, Array, Array | None, Array | None, bool]:
    """Return point (four coordinates), normal, direction, perspective and pseudo as `projection_matrix` takes them.

    Parameters
    ----------
    matrix
        A projection.
    pseudo
        Whether a central projection is one that keeps the order of depths; the matrix alone does not show it.

    Raises
    ------
    ValueError
        When it is no projection.
    """
    values = np.array(matrix, dtype=np.float64)
    bottom = float(np.linalg.norm(values[3, :3]))
    if bottom <= _TOLERANCE * np.abs(values).max():
        linear, shift = _split(values)
        left, sizes, right = np.linalg.svd(linear)
        _require(sizes[2] < 1e-6, "the matrix is no projection")
        return homogeneous(_fixed_point(linear, shift)), left[:, 2], right[2], None, False
    values /= bottom
    normal, height = -values[3, :3], values[3, 3]
    distance = (2.0 * height - np.trace(values[:3, :3]) - (1.0 if pseudo else 0.0)) / 3.0
    eye = (height - distance) * normal - values[:3, :3] @ normal - (normal if pseudo else 0.0)
    return homogeneous(distance * normal), normal, None, eye, pseudo


def shear_from_matrix(matrix: ArrayLike) -> tuple[float, Array, Array, Array]:
    """Return angle, direction, point (four coordinates) and normal as `shear_matrix` takes them.

    Raises
    ------
    ValueError
        When it is no shear.
    """
    linear, shift = _split(matrix)
    left, sizes, right = np.linalg.svd(linear - np.identity(3))
    tangent, direction, normal = float(sizes[0]), left[:, 0], right[0]
    if tangent <= EPSILON:
        return 0.0, np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 0.0, 1.0]), np.array([0.0, 0.0, 1.0])
    _require(sizes[1] < 1e-6 * max(1.0, tangent) and abs(direction @ normal) < 1e-6, "the matrix is no shear")
    point = -(shift @ direction) / tangent * normal
    return atan(tangent), direction, homogeneous(point), normal


def decompose_matrix(matrix: ArrayLike) -> tuple[Array, list[float], list[float], Array, Array]:
    """Return what a matrix is composed of.

    Returns
    -------
    scale : array of shape (3,)
        Along x, y and z.
    shear : list
        Of x by y, x by z and y by z.
    angles : list
        About the fixed axes x, y and z, in radians.
    translate : array of shape (3,)
    perspective : array of shape (4,)

    Raises
    ------
    ValueError
        When the matrix is singular.
    """
    values = np.array(matrix, dtype=np.float64)
    if abs(values[3, 3]) < EPSILON:
        raise ValueError("M[3, 3] is zero")
    values /= values[3, 3]
    affine = values.copy()
    affine[3] = (0.0, 0.0, 0.0, 1.0)
    if np.linalg.det(affine) == 0.0:
        raise ValueError("Matrix is singular")
    rotation, upper = np.linalg.qr(values[:3, :3])
    signs = np.where(np.diag(upper) < 0.0, -1.0, 1.0)
    if np.linalg.det(rotation * signs) < 0.0:
        signs = -signs
    rotation, upper = rotation * signs, upper * signs[:, np.newaxis]
    scale = np.diag(upper).copy()
    shear = [float(upper[0, 1] / scale[1]), float(upper[0, 2] / scale[2]), float(upper[1, 2] / scale[2])]
    return (
        scale,
        shear,
        list(euler_from_matrix(rotation)),
        values[:3, 3].copy(),
        values[3] @ np.linalg.inv(affine),
    )


def compose_matrix(
    scale: ArrayLike | None = None,
    shear: ArrayLike | None = None,
    angles: ArrayLike | None = None,
    translate: ArrayLike | None = None,
    perspective: ArrayLike | None = None,
) -> Array:
    """Return the matrix that scales, shears, turns, moves and projects, in this order; see `decompose_matrix`."""
    upper = np.identity(4)
    if shear is not None:
        upper[0, 1], upper[0, 2], upper[1, 2] = np.asarray(shear)
    if scale is not None:
        upper[:, :3] *= np.asarray(scale, dtype=np.float64)
    result = upper
    if angles is not None:
        ai, aj, ak = (float(angle) for angle in np.asarray(angles))
        result = euler_matrix(ai, aj, ak) @ upper
    if translate is not None:
        result[:3, 3] = np.asarray(translate, dtype=np.float64)[:3]
    if perspective is not None:
        result[3] = np.asarray(perspective, dtype=np.float64)[:4] @ result
    result /= result[3, 3]
    return result


def superimposition_matrix(v0: ArrayLike, v1: ArrayLike, scaling: bool = False, usesvd: bool = True) -> Array:
    """Return the matrix that brings points onto others with the least sum of squared distances.

    Parameters
    ----------
    v0, v1 : arrays of shape (3, n) or (4, n)
        The points, and where they should come to.
    scaling
        Whether the matrix may scale them.
    usesvd
        Whether the rotation is found by the singular values (Kabsch, 1978) or as a quaternion (Horn, 1987).
    """
    source, target = (np.array(points, dtype=np.float64)[:3] for points in (v0, v1))
    source_middle, target_middle = source.mean(axis=1), target.mean(axis=1)
    source -= source_middle[:, np.newaxis]
    target -= target_middle[:, np.newaxis]
    correlation = target @ source.T
    rotation = _kabsch(correlation) if usesvd else _horn(correlation)
    if scaling:
        rotation = rotation * np.sqrt(np.sum(target * target) / np.sum(source * source))
    matrix = np.identity(4)
    matrix[:3, :3] = rotation
    matrix[:3, 3] = target_middle - rotation @ source_middle
    return matrix


def _kabsch(correlation: Array) -> Array:
    left, _, right = np.linalg.svd(correlation)
    handedness = np.sign(np.linalg.det(left @ right))
    rotation: Array = left @ np.diag([1.0, 1.0, handedness]) @ right
    return rotation


def _horn(correlation: Array) -> Array:
    s = correlation.T
    antisymmetric = np.array([s[1, 2] - s[2, 1], s[2, 0] - s[0, 2], s[0, 1] - s[1, 0]])
    form = np.empty((4, 4))
    form[:3, :3] = s + s.T - np.trace(s) * np.identity(3)
    form[:3, 3] = form[3, :3] = antisymmetric
    form[3, 3] = np.trace(s)
    return quaternion_matrix(np.linalg.eigh(form)[1][:, 3])[:3, :3]


def _split(matrix: ArrayLike) -> tuple[Array, Array]:
    """Return the linear part and the translation."""
    values = np.array(matrix, dtype=np.float64)
    values = values / values[3, 3]
    return values[:3, :3], values[:3, 3]


def _leading(symmetric: Array) -> Array:
    """Return the direction of the largest column of a matrix of rank one."""
    column: Array = symmetric[:, np.argmax(np.sum(symmetric * symmetric, axis=0))]
    _require(bool(column.any()), "the matrix does nothing but move")
    result: Array = unit_vector(column)
    return result


def _fixed_point(linear: Array, shift: Array) -> Array:
    """Return the point nearest to the origin that stays where it is."""
    moved = np.identity(3) - linear
    point = np.asarray(np.linalg.lstsq(moved, shift, rcond=1e-9)[0], dtype=np.float64)
    tolerance = 1e-6 * max(1.0, float(np.abs(shift).max()))
    _require(np.allclose(moved @ point, shift, atol=tolerance), "the matrix leaves no point where it is")
    return point


def _require(condition: Any, problem: str) -> None:
    if not condition:
        raise ValueError(problem)
