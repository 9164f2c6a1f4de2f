"""Calibration of a moving head: its pose and small angles from directions to known points, by least squares.

Someone turns the head until its spot lies on a known point and notes pan and tilt. Four points in both flips determine
the pose, the zero of the tilt and both skews, since the flip changes the sign of what the angles do (as the two faces
of a theodolite do). The angles get a prior of one degree, so that few points in one flip still give a pose.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from daidalos.common.pose3 import Pose, Vector
from daidalos.industry.lighting.kinematics import Angles, Geometry

Array = NDArray[np.float64]
PRIOR = math.radians(1.0)
"""Standard deviation of the three angles before anything is measured [rad]."""
NOISE = math.radians(0.02)
"""Standard deviation of pan and tilt [rad]: two and a half steps of 16-bit pan over 540 degrees."""
PARAMETERS = ("x", "y", "z", "rotation x", "rotation y", "rotation z", "tilt_zero", "axis_skew", "beam_skew")
MIN_POINTS = 3
_YAWS = (0.0, 0.5 * math.pi, math.pi, 1.5 * math.pi)
_UNDETERMINED = "the directions do not determine the pose: check their order, and take points that are not on one line"
_WORST_POSITION = 1.0
_WORST_RESIDUAL = math.radians(1.0)


class CalibrationError(ValueError):
    """Error of observations that do not determine the head; the message states the remedy."""


@dataclass(frozen=True)
class Observation:
    """Pan and tilt [rad] at which the spot lay on a point of the world [m]."""

    point: Vector
    angles: Angles


@dataclass(frozen=True)
class Calibration:
    """Result of a calibration.

    Attributes
    ----------
    geometry : Geometry
    covariance : (9, 9) array
        Of `PARAMETERS`: position [m], rotation vector in the head's frame [rad] and the three angles [rad].
    residual : float
        Root mean square difference between the measured and the computed angles [rad].
    noise : float
        Standard deviation of pan and tilt that the covariance assumes [rad]: the residual's, or the given one where
        that is greater or too few directions were measured.
    condition : float
        Condition number of the equations, each parameter scaled by its own column.
    """

    geometry: Geometry
    covariance: Array
    residual: float
    noise: float
    condition: float


def calibrate(observations: Iterable[Observation], start: Geometry, noise: float = NOISE) -> Calibration:
    """Compute pose and angles of a head by least squares.

    First the pose alone is sought, from four yaws about the pan axis of the start, upright and hanging where neither
    explains the directions; then all parameters together.

    Parameters
    ----------
    observations : iterable of Observation
    start : Geometry
        About where the head is.
    noise : float
        Expected standard deviation of pan and tilt [rad].

    Raises
    ------
    CalibrationError
        With fewer than three points, or where they do not determine the pose.
    """
    points, angles = _arrays(observations)
    if len(np.unique(points, axis=0)) < MIN_POINTS:
        raise CalibrationError(f"{len(np.unique(points, axis=0))} points are too few: aim at {MIN_POINTS} or better 4")
    pose = _best_pose(points, angles, start)
    base = Rotation.from_rotvec(pose[3:])

    def residuals(parameters: Array) -> Array:
        errors = _axis_errors(_errors(parameters, base, points, angles), angles)
        return np.concatenate([errors / noise, parameters[6:] / PRIOR])

    solved = least_squares(residuals, np.concatenate([pose[:3], np.zeros(6)]), method="lm", x_scale="jac", max_nfev=400)
    errors = _axis_errors(_errors(solved.x, base, points, angles), angles)
    residual = float(np.sqrt(np.mean(errors**2)))
    if residual > _WORST_RESIDUAL:
        raise CalibrationError(
            f"the directions do not fit the points: they differ by {math.degrees(residual):.1f} degrees; check the "
            "order of the points, and whether pan is inverted"
        )
    scale = np.linalg.norm(solved.jac, axis=0)
    condition = float(np.linalg.cond(solved.jac / np.where(scale > 0.0, scale, 1.0)))
    if not np.all(scale > 0.0) or condition > 1e8:
        raise CalibrationError(_UNDETERMINED)
    freedom = 2 * len(points) - 6
    found = residual * math.sqrt(2 * len(points) / freedom) if freedom > 0 else 0.0
    assumed = max(noise, found)
    scaled = solved.jac.copy()
    scaled[:-3] *= noise / assumed
    covariance = np.linalg.inv(scaled.T @ scaled)
    if math.sqrt(np.trace(covariance[:3, :3])) > _WORST_POSITION:
        raise CalibrationError(_UNDETERMINED)
    return Calibration(_geometry(solved.x, base), covariance, residual, assumed, condition)


def expected_errors(calibration: Calibration, targets: Sequence[Vector]) -> Array:
    """Return the root mean square distance [m] by which the beam will miss each target."""
    jacobians = [_miss_jacobian(calibration.geometry, target) for target in targets]
    return np.array([math.sqrt(max(np.trace(one @ calibration.covariance @ one.T), 0.0)) for one in jacobians])


def propose(calibration: Calibration, targets: Sequence[Vector], candidates: Sequence[Observation]) -> Observation:
    """Return the candidate whose measurement reduces the greatest expected error over the targets most."""
    jacobians = np.array([_miss_jacobian(calibration.geometry, target) for target in targets])
    information = np.linalg.inv(calibration.covariance)

    def worst(candidate: Observation) -> float:
        rows = _direction_jacobian(calibration.geometry, candidate) / calibration.noise
        covariance = np.linalg.inv(information + rows.T @ rows)
        return float(np.max(np.einsum("tij,jk,tik->t", jacobians, covariance, jacobians)))

    return min(candidates, key=worst)


def grid(corner: tuple[float, float], opposite: tuple[float, float], height: float, count: int = 9) -> list[Vector]:
    """Return points of a table [m], ``count`` in each direction, row by row."""
    xs, ys = (np.linspace(one, other, count) for one, other in zip(corner, opposite, strict=True))
    return [(float(x), float(y), height) for y in ys for x in xs]


def miss(geometry: Geometry, angles: Angles, target: Vector) -> float:
    """Return the distance [m] by which the beam misses a target."""
    return float(np.linalg.norm(_miss(geometry, angles, target)))


def _best_pose(points: Array, angles: Array, start: Geometry) -> Array:
    """Return position and rotation vector of the head without angles, from several starts."""
    found: list[tuple[float, Array]] = []
    given = Rotation.from_quat(start.pose.orientation)
    for base in (given, given * Rotation.from_euler("x", math.pi)):
        for yaw in _YAWS:
            turned = base * Rotation.from_euler("z", yaw)
            solved = least_squares(
                lambda pose, turned=turned: _errors(np.append(pose, np.zeros(3)), turned, points, angles),
                np.append(start.pose.position, np.zeros(3)),
                method="lm",
                x_scale=[1.0, 1.0, 1.0, 0.3, 0.3, 0.3],
                max_nfev=150,
            )
            rotation = (turned * Rotation.from_rotvec(solved.x[3:])).as_rotvec()
            found.append((float(solved.cost), np.append(solved.x[:3], rotation)))
        best = min(found, key=lambda one: one[0])
        if math.sqrt(2.0 * best[0] / len(points)) < _WORST_RESIDUAL:
            break
    return best[1]


def _arrays(observations: Iterable[Observation]) -> tuple[Array, Array]:
    given = list(observations)
    points = np.array([one.point for one in given], float).reshape(-1, 3)
    angles = np.array([(one.angles.pan, one.angles.tilt) for one in given], float).reshape(-1, 2)
    if not (np.isfinite(points).all() and np.isfinite(angles).all()):
        raise CalibrationError("a point or an angle is not finite")
    return points, angles


def _errors(parameters: Array, base: Rotation, points: Array, angles: Array) -> Array:
    """Return the differences of the beam's unit vectors and those to the points, in the head's frame."""
    rotation = base * Rotation.from_rotvec(parameters[3:6])
    wanted = rotation.inv().apply(points - parameters[:3])
    wanted /= np.linalg.norm(wanted, axis=1)[:, None]
    errors: Array = (_directions(angles, *parameters[6:]) - wanted).ravel()
    return errors


def _axis_errors(errors: Array, angles: Array) -> Array:
    """Return errors of unit vectors as errors of pan and tilt [rad], those of pan at most ten times as large."""
    (pan, tilt), turned = angles.T, errors.reshape(-1, 3)
    along_pan = turned[:, 0] * np.sin(pan) - turned[:, 1] * np.cos(pan)
    along_tilt = np.cos(tilt) * (turned[:, 0] * np.cos(pan) + turned[:, 1] * np.sin(pan)) + np.sin(tilt) * turned[:, 2]
    found: Array = np.stack([along_pan / np.maximum(np.abs(np.sin(tilt)), 0.1), along_tilt], axis=1).ravel()
    return found


def _directions(angles: Array, tilt_zero: float, axis_skew: float, beam_skew: float) -> Array:
    """Return the beam's unit vectors in the head's frame, as `Geometry.direction` does for one."""
    tilt = angles[:, 1] + tilt_zero
    ahead, side = np.cos(tilt) * math.cos(beam_skew), math.sin(beam_skew)
    cosine, sine = math.cos(axis_skew), math.sin(axis_skew)
    x, y, z = -np.sin(tilt) * math.cos(beam_skew), -sine * ahead - cosine * side, cosine * ahead - sine * side
    c, s = np.cos(angles[:, 0]), np.sin(angles[:, 0])
    return np.stack([c * x - s * y, s * x + c * y, z], axis=1)


def _geometry(parameters: Array, base: Rotation) -> Geometry:
    x, y, z, tilt_zero, axis_skew, beam_skew = (float(one) for one in np.delete(parameters, [3, 4, 5]))
    qx, qy, qz, qw = (float(one) for one in (base * Rotation.from_rotvec(parameters[3:6])).as_quat())
    return Geometry(Pose((x, y, z), (qx, qy, qz, qw)), tilt_zero, axis_skew, beam_skew)


def _parameters(geometry: Geometry) -> tuple[Array, Rotation]:
    angles = (geometry.tilt_zero, geometry.axis_skew, geometry.beam_skew)
    return np.array([*geometry.pose.position, 0.0, 0.0, 0.0, *angles]), Rotation.from_quat(geometry.pose.orientation)


def _miss(geometry: Geometry, angles: Angles, target: Vector) -> Array:
    """Return the vector from a target to the nearest point of the beam [m]."""
    origin = np.array(geometry.pose.position)
    beam = np.array(geometry.point(angles, 1.0)) - origin
    way = np.array(target) - origin
    nearest: Array = (way @ beam) * beam - way
    return nearest


def _miss_jacobian(geometry: Geometry, target: Vector) -> Array:
    """Return the derivative of the miss at a target, with the angles held, by the parameters, shape (3, 9)."""
    angles = geometry.solutions(target)[0]
    parameters, base = _parameters(geometry)
    columns = []
    for index in range(9):
        step = np.zeros(9)
        step[index] = 1e-6
        ends = (_miss(_geometry(parameters + sign * step, base), angles, target) for sign in (1, -1))
        columns.append(np.subtract(*ends) / 2e-6)
    return np.array(columns).T


def _direction_jacobian(geometry: Geometry, observation: Observation) -> Array:
    """Return the derivative of an observation's error by the parameters, shape (2, 9)."""
    parameters, base = _parameters(geometry)
    points, angles = _arrays([observation])
    columns = []
    for index in range(9):
        step = np.zeros(9)
        step[index] = 1e-6
        ends = (_axis_errors(_errors(parameters + sign * step, base, points, angles), angles) for sign in (1, -1))
        columns.append(np.subtract(*ends) / 2e-6)
    return np.array(columns).T
