"""Positions, orientations and poses as lists: RAPID's own form, with quaternions [q1, q2, q3, q4] of which q1 is real.

Lengths are in mm and angles in degrees, as in RAPID.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from daidalos.industry.rapid.runtime.errors import RapidError

Vector = list[float]
Quaternion = list[float]
Pose = list[list[float]]

IDENTITY: Pose = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]]
MAX_NORM_ERROR = 0.1
"""Distance of a quaternion's length from 1 above which a controller refuses it."""


def normalized(q: Sequence[float]) -> Quaternion:
    """Return a quaternion of length 1.

    Raises
    ------
    RapidError
        ERR_ILLQUAT, where it is too far from one.
    """
    norm = math.sqrt(sum(one * one for one in q))
    if abs(norm - 1.0) > MAX_NORM_ERROR:
        raise RapidError("ERR_ILLQUAT", f"the orientation has the length {norm:.4g} in place of 1")
    return [one / norm for one in q]


def quaternion_product(a: Sequence[float], b: Sequence[float]) -> Quaternion:
    """Return the rotation b, then a."""
    a1, a2, a3, a4 = a
    b1, b2, b3, b4 = b
    return [
        a1 * b1 - a2 * b2 - a3 * b3 - a4 * b4,
        a1 * b2 + a2 * b1 + a3 * b4 - a4 * b3,
        a1 * b3 - a2 * b4 + a3 * b1 + a4 * b2,
        a1 * b4 + a2 * b3 - a3 * b2 + a4 * b1,
    ]


def rotate(q: Sequence[float], v: Sequence[float]) -> Vector:
    """Return a vector turned by a quaternion."""
    w, x, y, z = q
    a, b, c = v
    tx, ty, tz = 2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)
    return [a + w * tx + y * tz - z * ty, b + w * ty + z * tx - x * tz, c + w * tz + x * ty - y * tx]


def pose_product(a: Pose, b: Pose) -> Pose:
    """Return the pose b, given in the frame a, in the frame of a."""
    moved = rotate(a[1], b[0])
    return [[one + other for one, other in zip(a[0], moved, strict=True)], quaternion_product(a[1], b[1])]


def pose_inverse(pose: Pose) -> Pose:
    """Return the inverse of a pose."""
    q = [pose[1][0], -pose[1][1], -pose[1][2], -pose[1][3]]
    return [[-one for one in rotate(q, pose[0])], q]


def orientation_from_zyx(z: float, y: float, x: float) -> Quaternion:
    """Return the quaternion of rotations about z, then the new y, then the new x, in degrees."""
    halves = [math.radians(angle) / 2 for angle in (z, y, x)]
    qz, qy, qx = ([math.cos(h), *axis] for h, axis in zip(halves, _axes(halves), strict=True))
    return quaternion_product(quaternion_product(qz, qy), qx)


def _axes(halves: Sequence[float]) -> list[Vector]:
    sz, sy, sx = (math.sin(half) for half in halves)
    return [[0.0, 0.0, sz], [0.0, sy, 0.0], [sx, 0.0, 0.0]]


def euler_zyx(q: Sequence[float]) -> Vector:
    """Return the angles about z, y and x in degrees; the inverse of `orientation_from_zyx`."""
    w, x, y, z = q
    sine = max(-1.0, min(1.0, 2 * (w * y - z * x)))
    return [
        math.degrees(math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))),
        math.degrees(math.asin(sine)),
        math.degrees(math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))),
    ]


def angle_between(a: Sequence[float], b: Sequence[float]) -> float:
    """Return the angle between two orientations in degrees."""
    dot = abs(sum(one * other for one, other in zip(a, b, strict=True)))
    return math.degrees(2 * math.acos(min(1.0, dot)))


def frame_of_points(origin: Vector, on_x: Vector, in_plane: Vector) -> Pose:
    """Return the frame through a point on its origin, one on its x axis and one in its xy plane, with y above 0.

    Raises
    ------
    RapidError
        ERR_FRAME, where the points are on a line.
    """
    x = _unit([b - a for a, b in zip(origin, on_x, strict=True)])
    to_plane = [b - a for a, b in zip(origin, in_plane, strict=True)]
    z = _unit(cross(x, to_plane))
    return [list(origin), quaternion_of_axes(x, cross(z, x), z)]


def _unit(v: Vector) -> Vector:
    norm = math.sqrt(sum(one * one for one in v))
    if norm < 1e-6:
        raise RapidError("ERR_FRAME", "the points of the frame are on a line")
    return [one / norm for one in v]


def cross(a: Sequence[float], b: Sequence[float]) -> Vector:
    """Return the cross product."""
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def quaternion_of_axes(x: Vector, y: Vector, z: Vector) -> Quaternion:
    """Return the orientation of a frame by its axes (Shepperd's method)."""
    trace = x[0] + y[1] + z[2]
    candidates = [trace, x[0], y[1], z[2]]
    largest = candidates.index(max(candidates))
    if largest == 0:
        s = math.sqrt(trace + 1) * 2
        return [s / 4, (y[2] - z[1]) / s, (z[0] - x[2]) / s, (x[1] - y[0]) / s]
    if largest == 1:
        s = math.sqrt(1 + x[0] - y[1] - z[2]) * 2
        return [(y[2] - z[1]) / s, s / 4, (y[0] + x[1]) / s, (z[0] + x[2]) / s]
    if largest == 2:
        s = math.sqrt(1 + y[1] - x[0] - z[2]) * 2
        return [(z[0] - x[2]) / s, (y[0] + x[1]) / s, s / 4, (z[1] + y[2]) / s]
    s = math.sqrt(1 + z[2] - x[0] - y[1]) * 2
    return [(x[1] - y[0]) / s, (z[0] + x[2]) / s, (z[1] + y[2]) / s, s / 4]
