"""Kinematics of a moving head: pan, tilt and distance to a point, and back.

The head's frame has its origin where both axes meet and z along the pan axis, the beam's direction at tilt 0. The
Denavit-Hartenberg table is that of the Robotix-Academy Summer School 2019 (ZeMA), rows of theta, d, a, alpha:
``(q1, 0, 0, pi/2)``, ``(q2, 0, 0, -pi/2)``, ``(0, q3, 0, 0)``, which gives
``p = q3 (-cos q1 sin q2, -sin q1 sin q2, cos q2)``. A real head differs from it by three small angles, those of every
theodolite: the zero of the tilt, the tilt axis that is not square to the pan axis, and the beam that is not square to
the tilt axis.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from daidalos.common.pose3 import Pose, Vector

_TURN = 2.0 * math.pi
AXIS_TOLERANCE = 2e-4
"""Angle [rad] from the pan axis below which pan is kept: 0.6 mm at 3 m, and a step of 16-bit tilt is a third of it."""


class PointingError(ValueError):
    """Error of a point at which the head cannot aim; the message names the point, the need and the limit."""


@dataclass(frozen=True)
class Angles:
    """Pan and tilt [rad]."""

    pan: float
    tilt: float


@dataclass(frozen=True)
class Limits:
    """Ranges and speeds of the axes.

    Attributes
    ----------
    pan, tilt : (float, float)
        Least and greatest angle [rad].
    pan_speed, tilt_speed : float
        Greatest speeds [rad/s].
    acceleration : float
        Greatest acceleration of both axes [rad/s^2].
    """

    pan: tuple[float, float] = (-1.5 * math.pi, 1.5 * math.pi)
    tilt: tuple[float, float] = (-0.75 * math.pi, 0.75 * math.pi)
    pan_speed: float = 4.0
    tilt_speed: float = 4.0
    acceleration: float = 20.0

    def allow(self, angles: Angles) -> bool:
        """Return whether both angles are within their ranges."""
        return self.pan[0] <= angles.pan <= self.pan[1] and self.tilt[0] <= angles.tilt <= self.tilt[1]

    def duration(self, start: Angles, end: Angles) -> float:
        """Return how long the slower axis turns at full speed [s]."""
        return max(abs(end.pan - start.pan) / self.pan_speed, abs(end.tilt - start.tilt) / self.tilt_speed)


@dataclass(frozen=True)
class Geometry:
    """Pose of a head in the world, and its three angles that a calibration finds.

    Attributes
    ----------
    pose : Pose
        World from head; a head that hangs from the ceiling has its z axis downwards.
    tilt_zero : float
        True tilt where the tilt reads 0 [rad].
    axis_skew : float
        Angle by which the tilt axis is not square to the pan axis [rad].
    beam_skew : float
        Angle by which the beam is not square to the tilt axis [rad].
    """

    pose: Pose = field(default_factory=Pose)
    tilt_zero: float = 0.0
    axis_skew: float = 0.0
    beam_skew: float = 0.0

    def direction(self, angles: Angles) -> Vector:
        """Return the beam's unit vector in the head's frame."""
        x, y, z = self._unturned(angles.tilt + self.tilt_zero)
        cosine, sine = math.cos(angles.pan), math.sin(angles.pan)
        return cosine * x - sine * y, sine * x + cosine * y, z

    def point(self, angles: Angles, distance: float) -> Vector:
        """Return the point of the beam at a distance [m] from the head, in the world."""
        x, y, z = self.direction(angles)
        return self.pose.transform((distance * x, distance * y, distance * z))

    def local(self, point: Vector) -> Vector:
        """Return a point of the world in the head's frame."""
        return self.pose.inverse.transform(point)

    def solutions(self, point: Vector) -> tuple[Angles, Angles]:
        """Return both pairs of angles that aim at a point of the world, the second one flipped over.

        Pan is within half a turn of 0. On the pan axis, where every pan is right, it is 0. Points nearer to the pan
        axis than the skews can reach get the nearest direction.

        Raises
        ------
        PointingError
            When the point is not finite, or is the head's own position.
        """
        x, y, height = self.unit(point)
        cos_skew, cos_beam = math.cos(self.axis_skew), math.cos(self.beam_skew)
        cosine = (height + math.sin(self.axis_skew) * math.sin(self.beam_skew)) / (cos_skew * cos_beam)
        tilt = math.acos(max(-1.0, min(1.0, cosine)))
        first, second = (
            Angles(self._pan(x, y, sign * tilt), _wrapped(sign * tilt - self.tilt_zero)) for sign in (1, -1)
        )
        return first, second

    def unit(self, point: Vector) -> Vector:
        """Return the unit vector from the head to a point of the world, in the head's frame.

        Raises
        ------
        PointingError
            When the point is not finite, or is the head's own position.
        """
        x, y, z = self.local(point)
        distance = math.sqrt(x * x + y * y + z * z)
        if not math.isfinite(distance):
            raise PointingError(f"the point {_text(point)} is not finite")
        if distance < 1e-6:
            raise PointingError(f"the point {_text(point)} is where the head is")
        return x / distance, y / distance, z / distance

    def _pan(self, x: float, y: float, tilt: float) -> float:
        if math.hypot(x, y) < 1e-12:
            return 0.0
        beam_x, beam_y, _ = self._unturned(tilt)
        return _wrapped(math.atan2(y, x) - math.atan2(beam_y, beam_x))

    def _unturned(self, tilt: float) -> Vector:
        """Return the beam's direction at pan 0 and a true tilt."""
        ahead = math.cos(tilt) * math.cos(self.beam_skew)
        side = math.sin(self.beam_skew)
        cosine, sine = math.cos(self.axis_skew), math.sin(self.axis_skew)
        return -math.sin(tilt) * math.cos(self.beam_skew), -sine * ahead - cosine * side, cosine * ahead - sine * side


def aim(geometry: Geometry, limits: Limits, point: Vector, current: Angles) -> Angles:
    """Return the angles that aim at a point and are reached soonest from the current ones.

    All whole turns of pan within its range, and both solutions, compete: so a target that moves steadily never makes
    the head turn round, except where the range of pan ends. Within `AXIS_TOLERANCE` of the pan axis pan is kept.

    Raises
    ------
    PointingError
        When no angles within the ranges aim at it.
    """
    off_axis = math.hypot(*geometry.unit(point)[:2])
    pairs = geometry.solutions(point)
    if off_axis < AXIS_TOLERANCE:
        pan = min(max(current.pan, limits.pan[0]), limits.pan[1])
        pairs = (Angles(pan, pairs[0].tilt), Angles(pan, pairs[1].tilt))
    found = [Angles(pan, pair.tilt) for pair in pairs for pan in _turns(pair.pan, limits.pan)]
    allowed = [angles for angles in found if limits.allow(angles)]
    if not allowed:
        raise PointingError(_out_of_range(point, pairs, limits))
    return min(allowed, key=lambda angles: (limits.duration(current, angles), abs(angles.pan)))


def off_axis_angle(geometry: Geometry, point: Vector) -> float:
    """Return the angle [rad] between the pan axis, in either direction, and a point: near 0 pan must turn fast."""
    x, y, z = geometry.unit(point)
    return math.atan2(math.hypot(x, y), abs(z))


def _turns(pan: float, limits: tuple[float, float]) -> list[float]:
    """Return a pan and what differs from it by whole turns, within limits."""
    least = math.ceil((limits[0] - pan) / _TURN - 1e-12)
    most = math.floor((limits[1] - pan) / _TURN + 1e-12)
    return [min(max(pan + turn * _TURN, limits[0]), limits[1]) for turn in range(least, most + 1)]


def _out_of_range(point: Vector, pairs: tuple[Angles, Angles], limits: Limits) -> str:
    needs = " or ".join(f"pan {math.degrees(one.pan):.1f} and tilt {math.degrees(one.tilt):.1f}" for one in pairs)
    pan, tilt = ([f"{math.degrees(one):.0f}" for one in pair] for pair in (limits.pan, limits.tilt))
    reach = f"pan from {pan[0]} to {pan[1]}, tilt from {tilt[0]} to {tilt[1]}"
    return f"the point {_text(point)} is out of range: it needs {needs} degrees, the head has {reach}"


def _text(point: Vector) -> str:
    return f"[{', '.join(f'{value:.6g}' for value in point)}]"


def _wrapped(angle: float) -> float:
    return math.remainder(angle, _TURN)
