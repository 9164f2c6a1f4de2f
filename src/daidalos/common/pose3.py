"""Poses in space: position and unit quaternion (x, y, z, w) as small tuples, which are fast for one pose at a time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


@dataclass(frozen=True)
class Pose:
    """Position and orientation of a frame in another one.

    Parameters
    ----------
    position : tuple of 3 floats
        Origin of the frame [m].
    orientation : tuple of 4 floats
        Unit quaternion x, y, z, w that rotates vectors of the frame into the other one.
    """

    position: Vector = (0.0, 0.0, 0.0)
    orientation: Quaternion = (0.0, 0.0, 0.0, 1.0)

    @classmethod
    def from_xyz_rpy(cls, xyz: tuple[float, ...], rpy: tuple[float, ...] = (0.0, 0.0, 0.0)) -> Pose:
        """Make a pose from a position and fixed-axis roll, pitch, yaw [rad] as URDF and SDF write it."""
        return cls((xyz[0], xyz[1], xyz[2]), quaternion_from_rpy(rpy[0], rpy[1], rpy[2]))

    @classmethod
    def from_matrix(cls, matrix: NDArray[np.float64]) -> Pose:
        """Make a pose from a homogeneous (4, 4) or (3, 4) matrix."""
        x, y, z = (float(value) for value in matrix[:3, 3])
        return cls((x, y, z), quaternion_from_matrix(matrix[:3, :3]))

    def __matmul__(self, other: Pose) -> Pose:
        """Compose: the pose of `other`'s frame in this pose's parent."""
        return Pose(self.transform(other.position), multiply(self.orientation, other.orientation))

    @property
    def inverse(self) -> Pose:
        """Pose of the parent in this frame."""
        x, y, z, w = self.orientation
        turn = (-x, -y, -z, w)
        px, py, pz = rotate(turn, self.position)
        return Pose((-px, -py, -pz), turn)

    @property
    def matrix(self) -> NDArray[np.float64]:
        """Homogeneous (4, 4) matrix."""
        import numpy as np

        matrix = np.eye(4)
        matrix[:3, :3] = rotation_matrix(self.orientation)
        matrix[:3, 3] = self.position
        return matrix

    @property
    def rpy(self) -> Vector:
        """Fixed-axis roll, pitch and yaw [rad]."""
        x, y, z, w = self.orientation
        roll = math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
        pitch = math.asin(max(-1.0, min(1.0, 2 * (w * y - z * x))))
        return roll, pitch, self.yaw

    @property
    def yaw(self) -> float:
        """Heading about the parent's z axis [rad]."""
        return yaw_from_quaternion(self.orientation)

    def transform(self, point: tuple[float, ...]) -> Vector:
        """Return a point of this frame in the parent."""
        x, y, z = rotate(self.orientation, point)
        return x + self.position[0], y + self.position[1], z + self.position[2]


def quaternion_from_rpy(roll: float, pitch: float, yaw: float) -> Quaternion:
    """Return the quaternion x, y, z, w of fixed-axis roll, pitch and yaw [rad]."""
    cr, sr = math.cos(roll / 2), math.sin(roll / 2)
    cp, sp = math.cos(pitch / 2), math.sin(pitch / 2)
    cy, sy = math.cos(yaw / 2), math.sin(yaw / 2)
    return (
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )


def quaternion_from_yaw(yaw: float) -> Quaternion:
    """Return the quaternion x, y, z, w of a rotation about z [rad]."""
    return 0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2)


def yaw_from_quaternion(quaternion: Quaternion) -> float:
    """Return the heading about z [rad] of a unit quaternion x, y, z, w."""
    x, y, z, w = quaternion
    return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


def quaternion_from_rotation_vector(vector: Sequence[float]) -> Quaternion:
    """Return the quaternion x, y, z, w of a rotation about a vector by its length [rad]."""
    x, y, z = vector
    angle = math.sqrt(x * x + y * y + z * z)
    scale = math.sin(angle / 2) / angle if angle > 0.0 else 0.5
    return scale * x, scale * y, scale * z, math.cos(angle / 2)


def rotation_vector(quaternion: Quaternion) -> Vector:
    """Return axis times angle [rad] of a unit quaternion x, y, z, w; the angle is at most pi."""
    x, y, z, w = quaternion
    length = math.sqrt(x * x + y * y + z * z)
    if length == 0.0:
        return 0.0, 0.0, 0.0
    scale = (2.0 if w >= 0.0 else -2.0) * math.atan2(length, abs(w)) / length
    return x * scale, y * scale, z * scale


def quaternion_from_matrix(rotation: NDArray[np.float64]) -> Quaternion:
    """Return the quaternion x, y, z, w of a (3, 3) rotation matrix (Shepperd's method)."""
    (a, b, c), (d, e, f), (g, h, i) = ((float(v) for v in row) for row in rotation)
    trace = a + e + i
    if trace > 0:
        x, y, z, w = h - f, c - g, d - b, 1 + trace
    elif a >= e and a >= i:
        x, y, z, w = 1 + a - e - i, b + d, c + g, h - f
    elif e >= i:
        x, y, z, w = b + d, 1 + e - a - i, f + h, c - g
    else:
        x, y, z, w = c + g, f + h, 1 + i - a - e, d - b
    return normalize((x, y, z, w))


def quaternion_between(start: tuple[float, ...], end: tuple[float, ...]) -> Quaternion:
    """Return the quaternion x, y, z, w of the shortest rotation that takes the unit vector `start` to `end`."""
    dot = sum(s * e for s, e in zip(start, end, strict=True))
    if dot < -1 + 1e-12:
        axis = (1.0, 0.0, 0.0) if abs(start[0]) < 0.9 else (0.0, 1.0, 0.0)
        x, y, z = _cross(start, axis)
        return normalize((x, y, z, 0.0))
    x, y, z = _cross(start, end)
    return normalize((x, y, z, 1 + dot))


def normalize(quaternion: Quaternion) -> Quaternion:
    """Return the quaternion with length one."""
    x, y, z, w = quaternion
    length = math.sqrt(x * x + y * y + z * z + w * w)
    return x / length, y / length, z / length, w / length


def multiply(left: Quaternion, right: Quaternion) -> Quaternion:
    """Return the quaternion of the rotation `right` followed by `left`."""
    ax, ay, az, aw = left
    bx, by, bz, bw = right
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def rotate(quaternion: Quaternion, vector: Sequence[float]) -> Vector:
    """Return a vector of 3 numbers rotated by a unit quaternion x, y, z, w."""
    x, y, z, w = quaternion
    vx, vy, vz = vector
    tx, ty, tz = 2 * (y * vz - z * vy), 2 * (z * vx - x * vz), 2 * (x * vy - y * vx)
    return (
        vx + w * tx + y * tz - z * ty,
        vy + w * ty + z * tx - x * tz,
        vz + w * tz + x * ty - y * tx,
    )


def rotation_matrix(quaternion: Quaternion) -> NDArray[np.float64]:
    """Return the (3, 3) matrix of a unit quaternion x, y, z, w."""
    import numpy as np

    columns = [rotate(quaternion, axis) for axis in ((1.0, 0, 0), (0, 1.0, 0), (0, 0, 1.0))]
    return np.array(columns, dtype=np.float64).T


def interpolate(start: Pose, end: Pose, share: float) -> Pose:
    """Return the pose a share of the way from one to another: on the straight line, turning evenly."""
    x, y, z = (s + share * (e - s) for s, e in zip(start.position, end.position, strict=True))
    return Pose((x, y, z), normalize(slerp(start.orientation, end.orientation, share)))


def slerp(start: Quaternion, end: Quaternion, share: float) -> Quaternion:
    """Return the quaternion a share of the way along the shorter arc from one unit quaternion to another."""
    a, b, c, d = start
    e, f, g, h = end
    if a * e + b * f + c * g + d * h < 0.0:
        e, f, g, h = -e, -f, -g, -h
    i, j, k, m = e - a, f - b, g - c, h - d
    rest = 1.0 - share
    # The chord gives the half angle exactly where the arc is short; the dot product's arc cosine does not.
    angle = 2.0 * math.asin(min(0.5 * math.sqrt(i * i + j * j + k * k + m * m), 1.0))
    whole = math.sin(angle)
    u, v = (math.sin(rest * angle) / whole, math.sin(share * angle) / whole) if whole > 1e-12 else (rest, share)
    return u * a + v * e, u * b + v * f, u * c + v * g, u * d + v * h


def _cross(a: tuple[float, ...], b: tuple[float, ...]) -> Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]
