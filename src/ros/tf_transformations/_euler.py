"""Three angles about axes, in any of the 24 conventions.

A convention is a letter, ``s`` for axes that stay fixed or ``r`` for axes that turn along, and the three axes in the
order of the angles: ``sxyz`` is roll, pitch and yaw.
"""

from __future__ import annotations

from functools import lru_cache
from math import atan2, cos, hypot, sin
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ._quaternions import quaternion_matrix
from ._vectors import EPSILON, Array


class _Convention(NamedTuple):
    """Axes by number in the order in which they turn along; `third` is the one beside the first two."""

    first: int
    second: int
    last: int
    third: int
    sign: float
    fixed: bool

    @property
    def is_proper(self) -> bool:
        """Whether the first axis is the last one again."""
        return self.first == self.last


@lru_cache(maxsize=64)
def _convention(axes: str | tuple[int, int, int, int]) -> _Convention:
    """Read the name of a convention, or its numbers: innermost axis, parity, repetition and whether axes turn.

    Raises
    ------
    KeyError
        When there is none of that name.
    """
    name = axes.lower() if isinstance(axes, str) else _name(*axes)
    order = ["xyz".find(axis) for axis in name[1:]]
    if name[:1] not in {"s", "r"} or len(order) != 3 or -1 in order or order[1] in {order[0], order[2]}:
        raise KeyError(f"{axes!r}: the axes must be 's' or 'r' and three of 'xyz' of which no two neighbours are equal")
    fixed = name[0] == "s"
    first, second, last = reversed(order) if fixed else order
    sign = 1.0 if (second - first) % 3 == 1 else -1.0
    return _Convention(first, second, last, 3 - first - second, sign, fixed)


def _name(inner: int, parity: int, repetition: int, turns: int) -> str:
    middle, outer = (inner + 1 + parity) % 3, (inner + 2 - parity) % 3
    order = "".join("xyz"[axis] for axis in (inner, middle, inner if repetition else outer))
    return f"r{order[::-1]}" if turns else f"s{order}"


def euler_matrix(ai: float, aj: float, ak: float, axes: str = "sxyz") -> Array:
    """Return the homogeneous matrix of three angles in radians."""
    return quaternion_matrix(quaternion_from_euler(ai, aj, ak, axes))


def euler_from_matrix(matrix: ArrayLike, axes: str = "sxyz") -> tuple[float, float, float]:
    """Return the three angles, in radians, of the rotation of a matrix (3 x 3 or 4 x 4).

    Where two axes coincide (gimbal lock), one of the angles is zero: the last of fixed axes, the first of others.
    """
    convention = _convention(axes)
    i, j, _, k, e, _ = convention
    r = np.asarray(matrix, dtype=np.float64)[:3, :3].tolist()
    if convention.is_proper:
        sine = hypot(r[i][j], r[i][k])
        b = atan2(sine, r[i][i])
        locked = sine <= EPSILON
        a = 0.0 if locked else atan2(r[j][i], -e * r[k][i])
        c = atan2(-e * r[j][k], r[j][j]) if locked else atan2(r[i][j], e * r[i][k])
    else:
        cosine = hypot(r[i][i], r[i][j])
        b = atan2(e * r[i][k], cosine)
        locked = cosine <= EPSILON
        a = 0.0 if locked else atan2(-e * r[j][k], r[k][k])
        c = atan2(e * r[j][i], r[j][j]) if locked else atan2(-e * r[i][j], r[i][i])
    return (c, b, a) if convention.fixed else (a, b, c)


def euler_from_quaternion(quaternion: ArrayLike, axes: str = "sxyz") -> tuple[float, float, float]:
    """Return the three angles, in radians, of a quaternion (x, y, z, w)."""
    return euler_from_matrix(quaternion_matrix(quaternion), axes)


def quaternion_from_euler(ai: float, aj: float, ak: float, axes: str = "sxyz") -> Array:
    """Return the quaternion (x, y, z, w) of three angles in radians."""
    convention = _convention(axes)
    first, second, last, third, sign, fixed = convention
    if fixed:
        ai, ak = ak, ai
    ca, sa = cos(ai / 2.0), sin(ai / 2.0)
    cb, sb = cos(aj / 2.0), sin(aj / 2.0)
    cc, sc = cos(ak / 2.0), sin(ak / 2.0)
    result = np.empty(4)
    if convention.is_proper:
        result[first] = cb * (sa * cc + ca * sc)
        result[second] = sb * (ca * cc + sa * sc)
        result[third] = sign * sb * (sa * cc - ca * sc)
        result[3] = cb * (ca * cc - sa * sc)
    else:
        result[first] = sa * cb * cc + sign * ca * sb * sc
        result[second] = ca * sb * cc - sign * sa * cb * sc
        result[last] = ca * cb * sc + sign * sa * sb * cc
        result[3] = ca * cb * cc - sign * sa * sb * sc
    return result
