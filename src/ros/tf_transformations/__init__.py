"""Homogeneous matrices, Euler angles and quaternions (x, y, z, w), computed by transforms3d.

ROS's own package of this name wraps the same module of transforms3d, so that results agree to the last convention.

A matrix M of shape (4, 4) takes the point (x, y, z, 1), as a column, to M times it. Points and vectors may have three
or four components, angles are in radians. The name of a convention of Euler angles is ``s`` (axes that stay fixed) or
``r`` (axes that rotate along) and three axes: ``sxyz`` is roll, pitch and yaw. Functions named ``..._from_matrix``
raise ValueError for a matrix of another kind.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray
from transforms3d import _gohlketransforms as _transforms

Array: TypeAlias = NDArray[np.float64]
Axes: TypeAlias = "str | tuple[int, int, int, int]"
_AXES2TUPLE = _transforms._AXES2TUPLE


def _array(values: ArrayLike) -> Array:
    """Return a copy as an array of floats, the only input that transforms3d takes under NumPy 2."""
    return np.array(values, dtype=np.float64)


def _optional(values: ArrayLike | None) -> Array | None:
    return None if values is None else _array(values)


def _w_first(quaternion: ArrayLike) -> Array:
    return np.roll(_array(quaternion)[:4], 1)


def _w_last(quaternion: Array) -> Array:
    return np.roll(quaternion, -1)


# Matrices


def identity_matrix() -> Array:
    """Return the identity."""
    return np.identity(4)


def translation_matrix(direction: ArrayLike) -> Array:
    """Return the matrix that translates by a vector."""
    return _array(_transforms.translation_matrix(_array(direction)))


def translation_from_matrix(matrix: ArrayLike) -> Array:
    """Return the translation vector of a matrix."""
    return _array(_transforms.translation_from_matrix(_array(matrix)))


def reflection_matrix(point: ArrayLike, normal: ArrayLike) -> Array:
    """Return the matrix that mirrors at the plane through `point` with the given normal."""
    return _array(_transforms.reflection_matrix(_array(point), _array(normal)))


def reflection_from_matrix(matrix: ArrayLike) -> tuple[Array, Array]:
    """Return a point (four components) and the normal of the plane of a reflection."""
    result: tuple[Array, Array] = _transforms.reflection_from_matrix(_array(matrix))
    return result


def rotation_matrix(angle: float, direction: ArrayLike, point: ArrayLike | None = None) -> Array:
    """Return the matrix that rotates about the axis through `point` (the origin where None)."""
    return _array(_transforms.rotation_matrix(angle, _array(direction), _optional(point)))


def rotation_from_matrix(matrix: ArrayLike) -> tuple[float, Array, Array]:
    """Return the angle, the direction of the axis and a point on it (four components)."""
    result: tuple[float, Array, Array] = _transforms.rotation_from_matrix(_array(matrix))
    return result


def scale_matrix(factor: float, origin: ArrayLike | None = None, direction: ArrayLike | None = None) -> Array:
    """Return the matrix that scales about `origin`, along `direction` or (None) along all axes."""
    return _array(_transforms.scale_matrix(factor, _optional(origin), _optional(direction)))


def scale_from_matrix(matrix: ArrayLike) -> tuple[float, Array, Array | None]:
    """Return the factor, the fixed point (four components) and the direction (None: all) of a scaling."""
    result: tuple[float, Array, Array | None] = _transforms.scale_from_matrix(_array(matrix))
    return result


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
    eye, along = _optional(perspective), _optional(direction)
    return _array(_transforms.projection_matrix(_array(point), _array(normal), along, eye, pseudo))


def projection_from_matrix(
    matrix: ArrayLike, pseudo: bool = False
) -> tuple[Array, Array, Array | None, Array | None, bool]:
    """Return point (four components), normal, direction, perspective and pseudo as `projection_matrix` takes them."""
    found: tuple[Array, Array, Array | None, Array | None, bool]
    found = _transforms.projection_from_matrix(_array(matrix), pseudo)
    return found


def clip_matrix(
    left: float, right: float, bottom: float, top: float, near: float, far: float, perspective: bool = False
) -> Array:
    """Return the matrix that takes a frustum to the cube from -1 to 1.

    Parameters
    ----------
    left, right, bottom, top, near, far
        Bounds along x, y and z; those of x and y at the near plane where `perspective` is set.
    perspective
        Whether the frustum is a pyramid with its tip at the origin (divide by the fourth component), or a box.

    Raises
    ------
    ValueError
        When a lower bound is not below the upper one, or a perspective frustum does not begin before the eye.
    """
    return _array(_transforms.clip_matrix(left, right, bottom, top, near, far, perspective))


def shear_matrix(angle: float, direction: ArrayLike, point: ArrayLike, normal: ArrayLike) -> Array:
    """Return the matrix that shears by an angle along `direction`, on the plane through `point`.

    Raises
    ------
    ValueError
        When the direction is not perpendicular to the normal.
    """
    return _array(_transforms.shear_matrix(angle, _array(direction), _array(point), _array(normal)))


def shear_from_matrix(matrix: ArrayLike) -> tuple[float, Array, Array, Array]:
    """Return angle, direction, point (four components) and normal as `shear_matrix` takes them."""
    result: tuple[float, Array, Array, Array] = _transforms.shear_from_matrix(_array(matrix))
    return result


def decompose_matrix(matrix: ArrayLike) -> tuple[Array, list[float], list[float], Array, Array]:
    """Return what a matrix is composed of.

    Returns
    -------
    scale : array of shape (3,)
        Along x, y and z.
    shear : list
        Of x by y, x by z and y by z.
    angles : list
        About the fixed axes x, y and z.
    translate : array of shape (3,)
    perspective : array of shape (4,)

    Raises
    ------
    ValueError
        When the matrix is singular.
    """
    result: tuple[Array, list[float], list[float], Array, Array] = _transforms.decompose_matrix(_array(matrix))
    return result


def compose_matrix(
    scale: ArrayLike | None = None,
    shear: ArrayLike | None = None,
    angles: ArrayLike | None = None,
    translate: ArrayLike | None = None,
    perspective: ArrayLike | None = None,
) -> Array:
    """Return the matrix that scales, shears, rotates, translates and projects, in this order."""
    return _array(_transforms.compose_matrix(*map(_optional, (scale, shear, angles, translate, perspective))))


def orthogonalization_matrix(lengths: ArrayLike, angles: ArrayLike) -> Array:
    """Return the matrix from coordinates along the edges of a crystal's cell to Cartesian ones.

    Parameters
    ----------
    lengths
        Of the edges a, b and c.
    angles
        Between b and c, c and a, a and b, in degrees. Edge c lies on z, and b in the plane of y and z.
    """
    return _array(_transforms.orthogonalization_matrix(_array(lengths), _array(angles)))


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
    return _array(_transforms.superimposition_matrix(_array(v0), _array(v1), scaling, usesvd))


def inverse_matrix(matrix: ArrayLike) -> Array:
    """Return the inverse."""
    return _array(_transforms.inverse_matrix(_array(matrix)))


def concatenate_matrices(*matrices: ArrayLike) -> Array:
    """Return the product of matrices: the last one acts first."""
    return _array(_transforms.concatenate_matrices(*map(_array, matrices)))


def is_same_transform(matrix0: ArrayLike, matrix1: ArrayLike) -> bool:
    """Return whether two matrices transform points alike, up to rounding."""
    return bool(_transforms.is_same_transform(_array(matrix0), _array(matrix1)))


# Euler angles and quaternions


def euler_matrix(ai: float, aj: float, ak: float, axes: Axes = "sxyz") -> Array:
    """Return the homogeneous matrix of three angles."""
    return _array(_transforms.euler_matrix(ai, aj, ak, axes))


def euler_from_matrix(matrix: ArrayLike, axes: Axes = "sxyz") -> tuple[float, float, float]:
    """Return the three angles of the rotation of a matrix (3 x 3 or 4 x 4); one is zero in gimbal lock."""
    result: tuple[float, float, float] = _transforms.euler_from_matrix(_array(matrix), axes)
    return result


def euler_from_quaternion(quaternion: ArrayLike, axes: Axes = "sxyz") -> tuple[float, float, float]:
    """Return the three angles of a quaternion."""
    result: tuple[float, float, float] = _transforms.euler_from_quaternion(_w_first(quaternion), axes)
    return result


def quaternion_from_euler(ai: float, aj: float, ak: float, axes: Axes = "sxyz") -> Array:
    """Return the quaternion of three angles."""
    return _w_last(_transforms.quaternion_from_euler(ai, aj, ak, axes))


def quaternion_about_axis(angle: float, axis: ArrayLike) -> Array:
    """Return the quaternion of a rotation about an axis."""
    return _w_last(_transforms.quaternion_about_axis(angle, _array(axis)[:3]))


def quaternion_matrix(quaternion: ArrayLike) -> Array:
    """Return the homogeneous matrix of the rotation; the quaternion may have any length."""
    return _array(_transforms.quaternion_matrix(_w_first(quaternion)))


def quaternion_from_matrix(matrix: ArrayLike) -> Array:
    """Return the quaternion, with w not negative, of the rotation of a matrix (3 x 3 or 4 x 4)."""
    return _w_last(_transforms.quaternion_from_matrix(_array(matrix)))


def quaternion_multiply(quaternion1: ArrayLike, quaternion0: ArrayLike) -> Array:
    """Return the product: the rotation `quaternion0`, then `quaternion1`."""
    return _w_last(_transforms.quaternion_multiply(_w_first(quaternion1), _w_first(quaternion0)))


def quaternion_conjugate(quaternion: ArrayLike) -> Array:
    """Return the quaternion with the opposite axis."""
    return _w_last(_transforms.quaternion_conjugate(_w_first(quaternion)))


def quaternion_inverse(quaternion: ArrayLike) -> Array:
    """Return the quaternion whose product with this one is (0, 0, 0, 1)."""
    return _w_last(_transforms.quaternion_inverse(_w_first(quaternion)))


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
    return _w_last(_transforms.quaternion_slerp(_w_first(quat0), _w_first(quat1), fraction, spin, shortestpath))


def random_quaternion(rand: ArrayLike | None = None) -> Array:
    """Return a random rotation, uniformly distributed (Shoemake, 1992), or that of three numbers from 0 up to 1."""
    return _w_last(_transforms.random_quaternion(_optional(rand)))


def random_rotation_matrix(rand: ArrayLike | None = None) -> Array:
    """Return the matrix of a random rotation; see `random_quaternion`."""
    return _array(_transforms.random_rotation_matrix(_optional(rand)))


# Vectors


def vector_norm(data: ArrayLike, axis: int | None = None, out: Array | None = None) -> Any:
    """Return the length of a vector, or the lengths of those along an axis; None where they are put into `out`."""
    return _transforms.vector_norm(_array(data), axis, out)


def unit_vector(data: ArrayLike, axis: int | None = None, out: Array | None = None) -> Any:
    """Return a vector, or vectors along an axis, with length one; None where they are put into `out`."""
    return _transforms.unit_vector(_array(data), axis, out)


def random_vector(size: int | tuple[int, ...]) -> Array:
    """Return random numbers from 0 up to 1."""
    return _array(_transforms.random_vector(size))


# The arcball


class Arcball(_transforms.Arcball):  # type: ignore[misc]
    """Trackball that rotates an object with the mouse (Shoemake, 1992).

    Parameters
    ----------
    initial
        The orientation at first: a quaternion (x, y, z, w) or a homogeneous matrix.

    Raises
    ------
    ValueError
        When that is neither.
    """

    def __init__(self, initial: ArrayLike | None = None) -> None:
        orientation = _optional(initial)
        super().__init__(np.roll(orientation, 1) if orientation is not None and orientation.ndim == 1 else orientation)

    def setaxes(self, *axes: ArrayLike) -> None:
        """Set the axes that the rotation may be constrained to."""
        super().setaxes(*map(_array, axes))

    def setconstrain(self, constrain: bool) -> None:
        """Constrain the rotation to the nearest of the axes, or not."""
        self.constrain = constrain

    def getconstrain(self) -> bool:
        """Return whether the rotation is constrained to axes."""
        return bool(self.constrain)


def arcball_map_to_sphere(point: Sequence[float], center: Sequence[float], radius: float) -> Array:
    """Return the point of the unit sphere under a point of the screen, or the nearest one on its edge."""
    return _array(_transforms.arcball_map_to_sphere(point, center, radius))


def arcball_constrain_to_axis(point: ArrayLike, axis: ArrayLike) -> Array:
    """Return the point of the sphere nearest to another that is perpendicular to an axis, on the side of the eye."""
    return _array(_transforms.arcball_constrain_to_axis(_array(point), _array(axis)))


def arcball_nearest_axis(point: ArrayLike, axes: Sequence[ArrayLike]) -> Array:
    """Return the axis whose great circle comes nearest to a point of the sphere."""
    return _array(_transforms.arcball_nearest_axis(_array(point), [_array(axis) for axis in axes]))
