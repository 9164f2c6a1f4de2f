"""Calibration of the ZeMA workshop: distances by the law of sines on three points of a line, the pose by a fourth.

P1, P2 and P3 are on a line, P2 in the middle. The head sees the whole line under the angle ``theta1`` and its half from
P2 to P3 under ``theta2``. With ``c1 = c / sin(theta1)``, ``c2 = (c / 2) / sin(theta2)``, ``theta = theta2 - theta1``
the angle at P2 is ``delta2 = atan(c1 sin(theta) / (c2 - c1 cos(theta)))`` modulo pi, and the distance to P3 is
``c2 sin(delta2)``. The method is quick and needs no solver, and amplifies noise a lot: its result says how much.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from daidalos.common.pose3 import Pose, Vector
from daidalos.industry.lighting.calibration import CalibrationError, Observation
from daidalos.industry.lighting.kinematics import Geometry

Array = NDArray[np.float64]
_STEP = 1e-6
_MIDDLE_TOLERANCE = 1e-3
_LEAST_HEIGHT = 1e-3


@dataclass(frozen=True)
class LineDistance:
    """Distance to the end of a line.

    Attributes
    ----------
    distance : float
        From the head to the third point [m].
    amplification : float
        Standard deviation of the distance by that of both angles [m/rad]: at 9 m/rad, 0.05 degrees make 8 mm.
    """

    distance: float
    amplification: float


def distance_to_end(length: float, whole: float, half: float) -> LineDistance:
    """Return the distance from the head to the end P3 of a line.

    Parameters
    ----------
    length : float
        From P1 to P3 [m].
    whole, half : float
        Angles under which the head sees P1 to P3 and P2 to P3 [rad].

    Raises
    ------
    CalibrationError
        When the half is not smaller than the whole, or an angle is not within 0 and pi.
    """
    if not (length > 0.0 and 0.0 < half < whole < math.pi):
        raise CalibrationError("the half of the line must be seen under an angle above 0 and below the whole's")
    by_whole = (_distance(length, whole + _STEP, half) - _distance(length, whole - _STEP, half)) / (2 * _STEP)
    by_half = (_distance(length, whole, half + _STEP) - _distance(length, whole, half - _STEP)) / (2 * _STEP)
    return LineDistance(_distance(length, whole, half), math.hypot(by_whole, by_half))


def calibrate_by_sines(observations: Sequence[Observation]) -> tuple[Geometry, LineDistance]:
    """Return the pose of a head without small angles, and the distance it rests on.

    Parameters
    ----------
    observations : sequence of four Observation
        P1, P2 and P3 on a line with P2 in the middle, and a point beside it.

    Raises
    ------
    CalibrationError
        When there are not four, or they are not arranged so.
    """
    if len(observations) != 4:
        raise CalibrationError(f"the law of sines needs 4 points, got {len(observations)}")
    points = np.array([one.point for one in observations], float)
    beams = np.array([Geometry().direction(one.angles) for one in observations])
    length = float(np.linalg.norm(points[2] - points[0]))
    if length == 0.0 or np.linalg.norm(0.5 * (points[0] + points[2]) - points[1]) > _MIDDLE_TOLERANCE * length:
        raise CalibrationError("the second point must be in the middle between the first and the third")
    if _height(observations[3].point, observations[0].point, observations[2].point) <= _LEAST_HEIGHT * length:
        raise CalibrationError("the fourth point must be beside the line of the others")
    end = distance_to_end(length, _angle(beams[0], beams[2]), _angle(beams[1], beams[2]))
    start = distance_to_end(length, _angle(beams[0], beams[2]), _angle(beams[0], beams[1]))
    line = np.array([start.distance * beams[0], end.distance * beams[2]])
    middle = (line.mean(axis=0) @ beams[1]) * beams[1]
    known = np.vstack([line[0], middle, line[1]])
    return _pose(known, beams[3], points), end


def choose_line(observations: Sequence[Observation]) -> list[Observation] | None:
    """Return the first observations that are arranged for `calibrate_by_sines`, in its order; None without such.

    Of a point that was aimed at several times, the first observation counts.
    """
    first = list({one.point: one for one in reversed(observations)}.values())[::-1]
    for start, end in itertools.combinations(first, 2):
        middle = 0.5 * (np.array(start.point) + np.array(end.point))
        length = math.dist(start.point, end.point)
        inner = [one for one in first if math.dist(one.point, middle) <= _MIDDLE_TOLERANCE * length]
        beside = [one for one in first if _height(one.point, start.point, end.point) > _LEAST_HEIGHT * length]
        if inner and beside:
            return [start, inner[0], end, beside[0]]
    return None


def _height(point: Vector, start: Vector, end: Vector) -> float:
    """Return the distance of a point from the line through two others."""
    along = np.subtract(end, start)
    return float(np.linalg.norm(np.cross(along, np.subtract(point, start))) / np.linalg.norm(along))


def _distance(length: float, whole: float, half: float) -> float:
    c1, c2 = length / math.sin(whole), 0.5 * length / math.sin(half)
    theta = half - whole
    delta = math.atan2(c1 * math.sin(theta), c2 - c1 * math.cos(theta)) % math.pi
    return c2 * math.sin(delta)


def _pose(known: Array, beam: Array, points: Array) -> Geometry:
    """Return the pose from three points in the head's frame and the direction to a fourth."""
    wanted = np.linalg.norm(points[3] - points[:3], axis=1)
    # The fourth point is r beam, as far from P3 as it is in the world: r^2 - 2 r (beam P3) + P3^2 = wanted^2.
    along = float(beam @ known[2])
    under = along**2 - float(known[2] @ known[2]) + float(wanted[2]) ** 2
    ranges = [along + sign * math.sqrt(max(under, 0.0)) for sign in (1.0, -1.0)]
    fits = []
    for reach in ranges:
        local = np.vstack([known, reach * beam])
        rotation, residual = Rotation.align_vectors(points - points.mean(axis=0), local - local.mean(axis=0))
        fits.append((float(residual), rotation, points.mean(axis=0) - rotation.apply(local.mean(axis=0))))
    _, rotation, position = min(fits, key=lambda one: one[0])
    x, y, z = (float(one) for one in position)
    qx, qy, qz, qw = (float(one) for one in rotation.as_quat())
    return Geometry(Pose((x, y, z), (qx, qy, qz, qw)))


def _angle(one: Array, other: Array) -> float:
    return math.atan2(float(np.linalg.norm(np.cross(one, other))), float(one @ other))
