"""Corner paths: parabolas between two curves that touch both at the edge of a zone.

Between lines the path is the parabola whose tangents the lines are. Between other curves it is the cubic that has
their tangents at the edges; for lines that is the same parabola. The orientation is turned in its own, wider zone by
the cubic of de Casteljau, in the same way. With a joint movement on either side all of this happens to the angles.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from daidalos.industry.motion.curves import METRES_PER_RADIAN, Curve, JointCurve
from daidalos.industry.motion.orientations import (
    Array,
    conjugate,
    from_rotation_vectors,
    multiply,
    rotation_vectors,
    slerp,
)
from daidalos.industry.motion.pieces import Sampled

_STEP = 1e-5


@dataclass(frozen=True)
class Zone:
    """Sizes of a corner path about a point.

    Attributes
    ----------
    position : float
        Distance from the point at which the corner path begins [m].
    orientation : float
        Distance at which the reorientation begins [m].
    turning : float
        Angle before the point's orientation at which the reorientation begins [rad].
    """

    position: float
    orientation: float
    turning: float


def reduced(zone: Zone, before: Curve, after: Curve, is_of_joints: bool) -> tuple[float, float]:
    """Return the distances of corner path and reorientation [m], none more than half of a neighbouring curve.

    The corner path of angles has one distance.
    """
    half = 0.5 * min(before.length, after.length)
    distance = min(zone.position, half)
    if is_of_joints:
        return distance, distance
    turning = min(zone.turning / rate if (rate := _turning(one)) > 1e-9 else np.inf for one in (before, after))
    return distance, float(max(distance, min(zone.orientation, turning, half)))


def _turning(curve: Curve) -> float:
    """Return the rotation per length of a line or a circle [rad/m]."""
    assert not isinstance(curve, JointCurve)
    _, ends = curve.poses(np.array([0.0, curve.length]))
    angle = float(np.linalg.norm(rotation_vectors(multiply(conjugate(ends[0]), ends[1]))))
    return min(angle / curve.length, 1.0 / METRES_PER_RADIAN)


class PoseCorner:
    """Corner path of the tool, over distances from the point: below 0 before it, above 0 behind it.

    Parameters
    ----------
    before, after
        The curves.
    distance, turning
        From the point to the edges of the corner path and of the reorientation [m].
    """

    def __init__(self, before: Curve, after: Curve, distance: float, turning: float) -> None:
        assert not isinstance(before, JointCurve)
        assert not isinstance(after, JointCurve)
        self._before, self._after = before, after
        self._distance, self._turning = distance, turning
        self._points = _bezier(self._place(before, before.length, -distance), self._place(after, 0.0, distance))
        self._turns = self._controls()

    def poses(self, x: Array) -> tuple[Array, Array]:
        """Return positions (n, 3) and orientations (n, 4) at distances (n,) from the point."""
        u = np.clip((x + self._distance) / (2.0 * self._distance), 0.0, 1.0)[:, None]
        a, b, c, d = self._points
        positions = (1 - u) ** 3 * a + 3 * u * (1 - u) ** 2 * b + 3 * u**2 * (1 - u) * c + u**3 * d
        outside = self._before.poses(self._before.length + x)[0], self._after.poses(x)[0]
        edge = self._distance
        positions = np.where((x < -edge)[:, None], outside[0], np.where((x > edge)[:, None], outside[1], positions))
        return positions, self._orientations((x + self._turning) / (2.0 * self._turning))

    def _place(self, curve: Curve, point: float, x: float) -> tuple[Array, Array, float]:
        """Return the position at an edge, the tangent there, and the distance to the point."""
        assert not isinstance(curve, JointCurve)
        positions, _ = curve.poses(point + x + np.array([0.0, -_STEP, _STEP]))
        return positions[0], (positions[2] - positions[1]) / (2.0 * _STEP), abs(x)

    def _controls(self) -> tuple[Array, Array, Array, Array]:
        ends = []
        for curve, point, x in (
            (self._before, self._before.length, -self._turning),
            (self._after, 0.0, self._turning),
        ):
            assert not isinstance(curve, JointCurve)
            _, q = curve.poses(point + x + np.array([0.0, -_STEP, _STEP]))
            rate = rotation_vectors(multiply(conjugate(q[1]), q[2])) / (2.0 * _STEP)
            ends.append((q[0], rate * self._turning * (2.0 / 3.0)))
        (a, out), (d, into) = ends
        return a, multiply(a, from_rotation_vectors(out)), multiply(d, from_rotation_vectors(-into)), d

    def _orientations(self, u: Array) -> Array:
        rows = [np.broadcast_to(one, (len(u), 4)) for one in self._turns]
        while len(rows) > 1:
            rows = [slerp(one, other, u) for one, other in itertools.pairwise(rows)]
        return rows[0]


class JointCorner:
    """Corner path of the angles, over distances from the point.

    Parameters
    ----------
    before, after
        The sampled curves.
    length
        Length of the first.
    distance
        From the point to the edges [m].
    """

    def __init__(self, before: Sampled, after: Sampled, length: float, distance: float) -> None:
        self._distance = distance
        ends = []
        for sampled, x in ((before, length - distance), (after, distance)):
            angles, slopes, *_ = sampled.derivatives(np.array([x]))
            ends.append((angles[0], slopes[0], distance))
        self._points = _bezier(ends[0], ends[1])

    def joints(self, x: Array) -> Array:
        """Return angles (n, 6) at distances (n,) from the point."""
        u = ((x + self._distance) / (2.0 * self._distance))[:, None]
        a, b, c, d = self._points
        return np.asarray((1 - u) ** 3 * a + 3 * u * (1 - u) ** 2 * b + 3 * u**2 * (1 - u) * c + u**3 * d)


def _bezier(start: tuple[Array, Array, float], end: tuple[Array, Array, float]) -> tuple[Array, Array, Array, Array]:
    """Return the control points of the cubic with values and tangents at its ends, each with its distance."""
    (a, out, x), (d, into, y) = start, end
    return a, a + (2.0 / 3.0) * x * out, d - (2.0 / 3.0) * y * into, d
