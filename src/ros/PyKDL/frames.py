"""Vectors, rotations, frames, twists and wrenches; angles in radians, matrices row by row."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

_EPS = 1e-6
"""Sine below which two axes count as parallel, as in KDL."""


class _Stamped:
    """Base of what can have a header, as transformed objects do."""

    header: Any


class Vector(_Stamped):
    """Vector: of three numbers, the copy of another one, or zero."""

    _v: list[float]

    def __init__(self, x: float | Vector = 0.0, y: float = 0.0, z: float = 0.0) -> None:
        self._v = list(x._v) if isinstance(x, Vector) else [float(x), float(y), float(z)]

    def x(self, value: float | None = None) -> float:
        """Return the first number, after it was set if a value is given."""
        return self._number(0, value)

    def y(self, value: float | None = None) -> float:
        """Return the second number, after it was set if a value is given."""
        return self._number(1, value)

    def z(self, value: float | None = None) -> float:
        """Return the third number, after it was set if a value is given."""
        return self._number(2, value)

    def _number(self, index: int, value: float | None) -> float:
        if value is not None:
            self._v[index] = float(value)
        return self._v[index]

    @staticmethod
    def Zero() -> Vector:
        """Return the vector of zeros."""
        return Vector()

    def Norm(self, eps: float = _EPS) -> float:
        """Return the length."""
        return math.hypot(*self._v)

    def Normalize(self, eps: float = _EPS) -> float:
        """Scale to length 1, and return the length of before; a shorter one than `eps` becomes the first axis."""
        length = self.Norm()
        self._v = [one / length for one in self._v] if length >= eps else [1.0, 0.0, 0.0]
        return length

    def ReverseSign(self) -> None:
        """Change the sign of all numbers."""
        self._v = [-one for one in self._v]

    def __getitem__(self, index: int) -> float:
        return self._v[_checked(index, 3)]

    def __setitem__(self, index: int, value: float) -> None:
        self._v[_checked(index, 3)] = float(value)

    def __iter__(self) -> Iterator[float]:
        return iter(self._v)

    def __len__(self) -> int:
        return 3

    def __add__(self, other: Vector) -> Vector:
        return Vector(*(a + b for a, b in zip(self._v, other._v, strict=True)))

    def __sub__(self, other: Vector) -> Vector:
        return Vector(*(a - b for a, b in zip(self._v, other._v, strict=True)))

    def __neg__(self) -> Vector:
        return Vector(*(-one for one in self._v))

    def __mul__(self, other: float | Vector) -> Vector:
        """Return the multiple, or the cross product with another vector."""
        if isinstance(other, Vector):
            (a, b, c), (d, e, f) = self._v, other._v
            return Vector(b * f - c * e, c * d - a * f, a * e - b * d)
        return Vector(*(one * other for one in self._v))

    __rmul__ = __mul__

    def __truediv__(self, other: float) -> Vector:
        return Vector(*(one / other for one in self._v))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Vector) and self._v == other._v

    __hash__ = None  # type: ignore[assignment]  # it can change

    def __repr__(self) -> str:
        return "[" + ",".join(f"{one:12g}" for one in self._v) + "]"


class Rotation(_Stamped):
    """Rotation: of nine numbers, of three vectors that are its axes, the copy of another one, or the identity."""

    _m: list[float]

    def __init__(self, *numbers: Any) -> None:
        if not numbers:
            self._m = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
        elif len(numbers) == 1:
            self._m = list(numbers[0]._m)
        elif len(numbers) == 3:
            self._m = [axis[row] for row in range(3) for axis in numbers]
        elif len(numbers) == 9:
            self._m = [float(one) for one in numbers]
        else:
            raise TypeError(f"a rotation is made of 0, 1, 3 or 9 arguments, not {len(numbers)}")

    @staticmethod
    def Identity() -> Rotation:
        """Return the rotation by 0."""
        return Rotation()

    @staticmethod
    def RotX(angle: float) -> Rotation:
        """Return the rotation about the first axis."""
        c, s = math.cos(angle), math.sin(angle)
        return Rotation(1, 0, 0, 0, c, -s, 0, s, c)

    @staticmethod
    def RotY(angle: float) -> Rotation:
        """Return the rotation about the second axis."""
        c, s = math.cos(angle), math.sin(angle)
        return Rotation(c, 0, s, 0, 1, 0, -s, 0, c)

    @staticmethod
    def RotZ(angle: float) -> Rotation:
        """Return the rotation about the third axis."""
        c, s = math.cos(angle), math.sin(angle)
        return Rotation(c, -s, 0, s, c, 0, 0, 0, 1)

    @staticmethod
    def Rot(rotvec: Vector, angle: float) -> Rotation:
        """Return the rotation about an axis, which may have any length."""
        axis = Vector(rotvec)
        axis.Normalize()
        return Rotation.Rot2(axis, angle)

    @staticmethod
    def Rot2(rotvec: Vector, angle: float) -> Rotation:
        """Return the rotation about an axis of length 1 (Rodrigues)."""
        x, y, z = rotvec
        c, s = math.cos(angle), math.sin(angle)
        v = 1.0 - c
        return Rotation(
            *(c + v * x * x, v * x * y - s * z, v * x * z + s * y),
            *(v * x * y + s * z, c + v * y * y, v * y * z - s * x),
            *(v * x * z - s * y, v * y * z + s * x, c + v * z * z),
        )

    @staticmethod
    def RPY(roll: float, pitch: float, yaw: float) -> Rotation:
        """Return the rotation by roll, pitch and yaw about fixed axes."""
        return Rotation(Rotation.RotZ(yaw) * Rotation.RotY(pitch) * Rotation.RotX(roll))

    @staticmethod
    def EulerZYX(alfa: float, beta: float, gamma: float) -> Rotation:
        """Return the rotation by yaw, pitch and roll about moving axes."""
        return Rotation.RPY(gamma, beta, alfa)

    @staticmethod
    def EulerZYZ(alfa: float, beta: float, gamma: float) -> Rotation:
        """Return the rotation by Euler's angles about the moving axes z, y and z."""
        return Rotation(Rotation.RotZ(alfa) * Rotation.RotY(beta) * Rotation.RotZ(gamma))

    @staticmethod
    def Quaternion(x: float, y: float, z: float, w: float) -> Rotation:
        """Return the rotation of a quaternion of length 1."""
        return Rotation(
            *(w * w + x * x - y * y - z * z, 2 * x * y - 2 * w * z, 2 * x * z + 2 * w * y),
            *(2 * x * y + 2 * w * z, w * w - x * x + y * y - z * z, 2 * y * z - 2 * w * x),
            *(2 * x * z - 2 * w * y, 2 * y * z + 2 * w * x, w * w - x * x - y * y + z * z),
        )

    def GetRPY(self) -> tuple[float, float, float]:
        """Return roll, pitch and yaw."""
        pitch = math.atan2(-self[2, 0], math.hypot(self[0, 0], self[1, 0]))
        if abs(pitch) > math.pi / 2.0 - 1e-12:
            return 0.0, pitch, math.atan2(-self[0, 1], self[1, 1])
        return math.atan2(self[2, 1], self[2, 2]), pitch, math.atan2(self[1, 0], self[0, 0])

    def GetEulerZYX(self) -> tuple[float, float, float]:
        """Return yaw, pitch and roll."""
        return self.GetRPY()[::-1]

    def GetEulerZYZ(self) -> tuple[float, float, float]:
        """Return Euler's angles about the moving axes z, y and z."""
        beta = math.atan2(math.hypot(self[0, 2], self[1, 2]), self[2, 2])
        if math.sin(beta) < _EPS:
            turned = math.atan2(self[1, 0], self[0, 0])
            return (turned, 0.0, 0.0) if self[2, 2] > 0.0 else (math.atan2(-self[1, 0], -self[0, 0]), math.pi, 0.0)
        return math.atan2(self[1, 2], self[0, 2]), beta, math.atan2(self[2, 1], -self[2, 0])

    def GetQuaternion(self) -> tuple[float, float, float, float]:
        """Return the quaternion (x, y, z, w), by the largest of its parts (Shepperd)."""
        m = self
        trace = m[0, 0] + m[1, 1] + m[2, 2]
        if trace > 1e-12:
            s = 0.5 / math.sqrt(trace + 1.0)
            return (m[2, 1] - m[1, 2]) * s, (m[0, 2] - m[2, 0]) * s, (m[1, 0] - m[0, 1]) * s, 0.25 / s
        i = max(range(3), key=lambda axis: m[axis, axis])
        j, k = (i + 1) % 3, (i + 2) % 3
        s = 2.0 * math.sqrt(1.0 + m[i, i] - m[j, j] - m[k, k])
        parts = [0.0, 0.0, 0.0]
        parts[i] = 0.25 * s
        parts[j] = (m[j, i] + m[i, j]) / s
        parts[k] = (m[k, i] + m[i, k]) / s
        return parts[0], parts[1], parts[2], (m[k, j] - m[j, k]) / s

    def GetRot(self) -> Vector:
        """Return the axis, with the angle as its length."""
        angle, axis = self.GetRotAngle()
        return axis * angle

    def GetRotAngle(self, eps: float = _EPS) -> tuple[float, Vector]:
        """Return the angle, from 0 to pi, and the axis."""
        x, y, z, w = self.GetQuaternion()
        if w < 0.0:
            x, y, z, w = -x, -y, -z, -w
        length = math.hypot(x, y, z)
        if length < eps / 2.0:
            return 0.0, Vector(0, 0, 1)
        return 2.0 * math.atan2(length, w), Vector(x, y, z) / length

    def DoRotX(self, angle: float) -> None:
        """Rotate further about the first axis of the rotated frame."""
        self._m = (self * Rotation.RotX(angle))._m

    def DoRotY(self, angle: float) -> None:
        """Rotate further about the second axis of the rotated frame."""
        self._m = (self * Rotation.RotY(angle))._m

    def DoRotZ(self, angle: float) -> None:
        """Rotate further about the third axis of the rotated frame."""
        self._m = (self * Rotation.RotZ(angle))._m

    def UnitX(self) -> Vector:
        """Return the first axis of the rotated frame."""
        return self._axis(0)

    def UnitY(self) -> Vector:
        """Return the second axis of the rotated frame."""
        return self._axis(1)

    def UnitZ(self) -> Vector:
        """Return the third axis of the rotated frame."""
        return self._axis(2)

    def _axis(self, column: int) -> Vector:
        return Vector(self[0, column], self[1, column], self[2, column])

    def Inverse(self, operand: Any = None) -> Any:
        """Return the inverse rotation, or what it makes of an operand."""
        inverse = Rotation(*(self[column, row] for row in range(3) for column in range(3)))
        return inverse if operand is None else inverse * operand

    def SetInverse(self) -> None:
        """Become the inverse rotation."""
        self._m = self.Inverse()._m

    def __getitem__(self, place: tuple[int, int]) -> float:
        return self._m[3 * _checked(place[0], 3) + _checked(place[1], 3)]

    def __setitem__(self, place: tuple[int, int], value: float) -> None:
        self._m[3 * _checked(place[0], 3) + _checked(place[1], 3)] = float(value)

    def __mul__(self, other: Any) -> Any:
        if isinstance(other, Vector):
            return Vector(*(sum(self[row, k] * other[k] for k in range(3)) for row in range(3)))
        if isinstance(other, Rotation):
            return Rotation(
                *(sum(self[row, k] * other[k, col] for k in range(3)) for row in range(3) for col in range(3))
            )
        if isinstance(other, Twist):
            return Twist(self * other.vel, self * other.rot)
        if isinstance(other, Wrench):
            return Wrench(self * other.force, self * other.torque)
        return NotImplemented

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Rotation) and self._m == other._m

    __hash__ = None  # type: ignore[assignment]  # it can change

    def __repr__(self) -> str:
        rows = (",".join(f"{self[row, col]:12g}" for col in range(3)) for row in range(3))
        return "[" + ";\n ".join(rows) + "]"


class Frame(_Stamped):
    """Frame: a rotation `M` and an origin `p`, one of them, the copy of another frame, or the identity."""

    M: Rotation
    p: Vector

    def __init__(self, first: Rotation | Vector | Frame | None = None, p: Vector | None = None) -> None:
        self.M = Rotation(first.M if isinstance(first, Frame) else first) if _rotates(first) else Rotation()
        origin = first.p if isinstance(first, Frame) else first if isinstance(first, Vector) else p
        self.p = Vector(origin) if origin is not None else Vector()

    @staticmethod
    def Identity() -> Frame:
        """Return the frame without rotation at the origin."""
        return Frame()

    @staticmethod
    def DH(a: float, alpha: float, d: float, theta: float) -> Frame:
        """Return the frame after a joint by the parameters of Denavit and Hartenberg."""
        return Frame(Frame(Rotation.RotZ(theta), Vector(0, 0, d)) * Frame(Rotation.RotX(alpha), Vector(a, 0, 0)))

    @staticmethod
    def DH_Craig1989(a: float, alpha: float, d: float, theta: float) -> Frame:
        """Return the frame after a joint by the modified parameters (Craig 1989)."""
        return Frame(Frame(Rotation.RotX(alpha), Vector(a, 0, 0)) * Frame(Rotation.RotZ(theta), Vector(0, 0, d)))

    def Inverse(self, operand: Any = None) -> Any:
        """Return the inverse frame, or what it makes of an operand."""
        turned = self.M.Inverse()
        inverse = Frame(turned, -(turned * self.p))
        return inverse if operand is None else inverse * operand

    def Integrate(self, twist: Twist, frequency: float) -> None:
        """Move by a twist in this frame for a period of a frequency [Hz]."""
        turn = twist.rot / frequency
        angle = turn.Norm()
        step = twist.vel / frequency
        self.p = self.p + self.M * step
        if angle > 0.0:
            self.M = self.M * Rotation.Rot(turn, angle)

    def __getitem__(self, place: tuple[int, int]) -> float:
        row, column = _checked(place[0], 4), _checked(place[1], 4)
        if row == 3:
            return 1.0 if column == 3 else 0.0
        return self.p[row] if column == 3 else self.M[row, column]

    def __setitem__(self, place: tuple[int, int], value: float) -> None:
        row, column = _checked(place[0], 3), _checked(place[1], 4)
        if column == 3:
            self.p[row] = value
        else:
            self.M[row, column] = value

    def __mul__(self, other: Any) -> Any:
        if isinstance(other, Vector):
            return self.M * other + self.p
        if isinstance(other, Frame):
            return Frame(self.M * other.M, self.M * other.p + self.p)
        if isinstance(other, Twist):
            turn = self.M * other.rot
            return Twist(self.M * other.vel + self.p * turn, turn)
        if isinstance(other, Wrench):
            force = self.M * other.force
            return Wrench(force, self.M * other.torque + self.p * force)
        return NotImplemented

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Frame) and self.M == other.M and self.p == other.p

    __hash__ = None  # type: ignore[assignment]  # it can change

    def __repr__(self) -> str:
        return f"[{self.M!r}\n{self.p!r}]"


def _rotates(first: object) -> bool:
    return isinstance(first, Rotation | Frame)


class _Pair(_Stamped):
    """Base of twists and wrenches: six numbers in two vectors."""

    _names: tuple[str, str]

    def __init__(self, first: Any = None, second: Vector | None = None) -> None:
        one, other = self._names
        if isinstance(first, _Pair):
            first, second = getattr(first, one), getattr(first, other)
        setattr(self, one, Vector(first) if first is not None else Vector())
        setattr(self, other, Vector(second) if second is not None else Vector())

    def _parts(self) -> tuple[Vector, Vector]:
        return getattr(self, self._names[0]), getattr(self, self._names[1])

    @classmethod
    def Zero(cls) -> Any:
        """Return the one of zeros."""
        return cls()

    def ReverseSign(self) -> None:
        """Change the sign of all numbers."""
        for part in self._parts():
            part.ReverseSign()

    def __getitem__(self, index: int) -> float:
        return self._parts()[_checked(index, 6) // 3][index % 3]

    def __setitem__(self, index: int, value: float) -> None:
        self._parts()[_checked(index, 6) // 3][index % 3] = value

    def __iter__(self) -> Iterator[float]:
        return (one for part in self._parts() for one in part)

    def __len__(self) -> int:
        return 6

    def __add__(self, other: Any) -> Any:
        return type(self)(*(a + b for a, b in zip(self._parts(), other._parts(), strict=True)))

    def __sub__(self, other: Any) -> Any:
        return type(self)(*(a - b for a, b in zip(self._parts(), other._parts(), strict=True)))

    def __neg__(self) -> Any:
        return type(self)(*(-part for part in self._parts()))

    def __mul__(self, factor: float) -> Any:
        return type(self)(*(part * factor for part in self._parts()))

    __rmul__ = __mul__

    def __truediv__(self, divisor: float) -> Any:
        return type(self)(*(part / divisor for part in self._parts()))

    def __eq__(self, other: object) -> bool:
        return type(other) is type(self) and list(self) == list(other)

    __hash__ = None  # type: ignore[assignment]  # it can change

    def __repr__(self) -> str:
        return "[" + ",".join(f"{one:12g}" for one in self) + "]"


class Twist(_Pair):
    """Twist: a velocity `vel` and an angular velocity `rot`."""

    _names = ("vel", "rot")
    vel: Vector
    rot: Vector

    def RefPoint(self, base: Vector) -> Twist:
        """Return the twist at another point, given from the present one."""
        return Twist(self.vel + self.rot * base, self.rot)


class Wrench(_Pair):
    """Wrench: a force `force` and a torque `torque`."""

    _names = ("force", "torque")
    force: Vector
    torque: Vector

    def RefPoint(self, base: Vector) -> Wrench:
        """Return the wrench at another point, given from the present one."""
        return Wrench(self.force, self.torque + self.force * base)


def _checked(index: int, size: int) -> int:
    if not 0 <= index < size:
        raise IndexError(f"the index {index} is not from 0 to {size - 1}")
    return index
