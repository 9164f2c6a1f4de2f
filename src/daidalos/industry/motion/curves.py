"""Geometry of single movements: lines, circles and joint movements, each over its length in metres.

The tool's centre point moves along the curve at one metre per unit of length. A rotation about a point that (almost)
stands still counts `METRES_PER_RADIAN`, the ratio of the reorientation zones in mm and degrees that ABB predefines.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from daidalos.industry.motion.faults import CIRCLE, MotionFault
from daidalos.industry.motion.kinematics import forward
from daidalos.industry.motion.orientations import (
    Array,
    conjugate,
    from_rotation_vectors,
    matrices,
    multiply,
    rotation_vectors,
    slerp,
)
from daidalos.industry.robots import Arm

METRES_PER_RADIAN = 0.01 * 180.0 / math.pi
MAX_ARC = math.radians(240.0)
"""Greatest angle of the circle of one instruction [rad]."""

SHORTEST = 1e-7
"""Length below which a movement is none [m]."""

_IN_PLACE = 0.1
"""Way of the tool as a share of what its rotation counts, up to which the movement is a rotation."""

_LONG_TURN = math.radians(115.0)
_LENGTH_SAMPLES = 33

CircleMode = Literal["path", "object", "point"]


@dataclass(frozen=True)
class Line:
    """A line, with the orientation turned about one axis at a constant rate.

    Attributes
    ----------
    start, end : (3,) arrays
        Positions of the tool in the base [m].
    turned_from, turned_to : (4,) arrays
        Orientations of the tool in the base, quaternions x, y, z, w.
    """

    start: Array
    end: Array
    turned_from: Array
    turned_to: Array

    @functools.cached_property
    def length(self) -> float:
        """Return the length [m]."""
        way = float(np.linalg.norm(self.end - self.start))
        turned = METRES_PER_RADIAN * _angle(self.turned_from, self.turned_to)
        return way if way > _IN_PLACE * turned else turned

    def poses(self, x: Array) -> tuple[Array, Array]:
        """Return positions (n, 3) and orientations (n, 4) of the tool at distances (n,) from the start."""
        share = x / self.length
        positions = self.start + share[:, None] * (self.end - self.start)
        return positions, slerp(self.turned_from, self.turned_to, share)


@dataclass(frozen=True)
class Circle:
    """An arc of a circle.

    Attributes
    ----------
    centre, first, second : (3,) arrays
        Centre, and the radii towards the start and a quarter turn on [m].
    angle : float
        Angle of the arc [rad].
    via_share : float
        Where on the arc the point between is, from 0 to 1.
    turned_from, turned_by : (4,) arrays
        Orientations at the start and at the point between.
    turned_to : (4,) array
        Orientation at the end.
    mode : str
        ``path`` keeps the orientation to the path, ``object`` turns it about one axis, ``point`` passes that of the
        point between; as CirPathMode.
    """

    centre: Array
    first: Array
    second: Array
    angle: float
    via_share: float
    turned_from: Array
    turned_by: Array
    turned_to: Array
    mode: CircleMode = "path"

    @classmethod
    def through(
        cls,
        points: tuple[Array, Array, Array],
        orientations: tuple[Array, Array, Array],
        mode: CircleMode = "path",
    ) -> Circle:
        """Return the arc from the first point through the second to the third.

        Raises
        ------
        MotionFault
            Where the points are on a line, too close, or more than 240 degrees apart.
        """
        start, via, end = points
        to_via, to_end = via - start, end - start
        normal = np.cross(to_via, to_end)
        size = float(np.linalg.norm(normal))
        shortest = min(float(np.linalg.norm(one)) for one in (to_via, to_end, end - via))
        if shortest < 1e-4:
            raise MotionFault(CIRCLE, f"two of the three points are {1e3 * shortest:.3f} mm apart")
        if size < 1e-5 * float(np.linalg.norm(to_via)) * float(np.linalg.norm(to_end)):
            raise MotionFault(CIRCLE, "the three points are on a line")
        to_centre = np.cross(to_via @ to_via * to_end - to_end @ to_end * to_via, normal) / (2.0 * size**2)
        first = -to_centre
        second = np.cross(normal / size, first)
        angles = [
            math.atan2(float((one - to_centre) @ second), float((one - to_centre) @ first)) % (2.0 * math.pi)
            for one in (to_via, to_end)
        ]
        if angles[1] > MAX_ARC + 1e-6:
            raise MotionFault(CIRCLE, f"the arc has {math.degrees(angles[1]):.1f} deg, more than 240; use two")
        share = angles[0] / angles[1]
        return cls(start + to_centre, first, second, angles[1], share, *orientations, mode)

    @functools.cached_property
    def length(self) -> float:
        """Return the length [m]."""
        return self.angle * float(np.linalg.norm(self.first))

    def poses(self, x: Array) -> tuple[Array, Array]:
        """Return positions (n, 3) and orientations (n, 4) of the tool at distances (n,) from the start."""
        share = x / self.length
        angle = (self.angle * share)[:, None]
        positions = self.centre + np.cos(angle) * self.first + np.sin(angle) * self.second
        return positions, self._orientations(share)

    def _orientations(self, share: Array) -> Array:
        if self.mode == "object":
            return slerp(self.turned_from, self.turned_to, share)
        if self.mode == "point":
            return self._through_via(share)
        normal = np.cross(self.first, self.second)
        normal /= np.linalg.norm(normal)
        with_path = multiply(from_rotation_vectors(self.angle * share[:, None] * normal), self.turned_from)
        return multiply(with_path, from_rotation_vectors(share[:, None] * self._turn_to_path(normal)))

    def _turn_to_path(self, normal: Array) -> Array:
        """Return the rotation vector by which the tool turns against the path, in the tool's frame.

        It is the shorter one; where both are long, that with which the tool turns less in the base.
        """
        at_end = multiply(from_rotation_vectors(self.angle * normal), self.turned_from)
        short = rotation_vectors(multiply(conjugate(at_end), self.turned_to))
        size = float(np.linalg.norm(short))
        if size < _LONG_TURN:
            return short
        with_path = self.angle * (matrices(self.turned_from[None])[0].T @ normal)
        both = (short, short * (1.0 - 2.0 * math.pi / size))
        return min(both, key=lambda one: float(np.linalg.norm(one + with_path)))

    def _through_via(self, share: Array) -> Array:
        """Return the rotation vectors' parabola through the orientation of the point between."""
        inverse = conjugate(self.turned_from)
        by, to = (rotation_vectors(multiply(inverse, one)) for one in (self.turned_by, self.turned_to))
        bend = (by - self.via_share * to) / (self.via_share * (self.via_share - 1.0))
        u = share[:, None]
        return multiply(self.turned_from, from_rotation_vectors(u * to + u * (u - 1.0) * bend))


@dataclass(frozen=True)
class JointCurve:
    """A movement in which all axes move in proportion.

    Attributes
    ----------
    start, end : (6,) arrays
        Angles [rad].
    length : float
        Length of the way of the tool's centre point [m], or what its rotation counts where that is more.
    """

    start: Array
    end: Array
    length: float

    @classmethod
    def between(cls, arm: Arm, tool: Array, start: Array, end: Array) -> JointCurve:
        """Return the movement between angles with a tool (4, 4) on the flange."""
        share = np.linspace(0.0, 1.0, _LENGTH_SAMPLES)[:, None]
        poses = forward(arm, start + share * (end - start)) @ tool
        way = float(np.linalg.norm(np.diff(poses[:, :3, 3], axis=0), axis=1).sum())
        turned = METRES_PER_RADIAN * float(np.abs(end - start).max())
        return cls(start, end, max(way, turned if way < SHORTEST else 0.0, 1e-3 * turned))

    def joints(self, x: Array) -> Array:
        """Return angles (n, 6) at distances (n,) from the start."""
        return np.asarray(self.start + (x / self.length)[:, None] * (self.end - self.start))


Curve = Line | Circle | JointCurve


def _angle(start: Array, end: Array) -> float:
    return float(np.linalg.norm(rotation_vectors(multiply(conjugate(start), end))))
