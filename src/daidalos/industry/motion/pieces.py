"""Pieces of a path: angles as splines of the length, with the limits that hold on them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from scipy.spatial.transform import Rotation

from daidalos.industry.motion.branches import check_ranges, flange_poses, follow
from daidalos.industry.motion.curves import Circle, Curve, JointCurve, Line
from daidalos.industry.motion.faults import OUT_OF_REACH, MotionFault
from daidalos.industry.motion.kinematics import forward
from daidalos.industry.motion.orientations import Array, continuous
from daidalos.industry.motion.spline_kernels import spline_slopes, spline_values
from daidalos.industry.robots import Arm

_STEP = 0.005
_TURN_STEP = math.radians(2.0)
_FEWEST, _MOST = 9, 1500
_SMALL = 1e-9
_NEWTON_STEPS, _NEWTON_TOLERANCE, _DIFFERENCE = 20, 1e-10, 1e-6

PoseFunction = Callable[[Array], tuple[Array, Array]]
"""Positions (n, 3) and orientations (n, 4) of the tool at distances (n,)."""


@dataclass(frozen=True)
class Limits:
    """Limits of one movement besides those of the arm.

    Attributes
    ----------
    speed : float
        Greatest speed of the tool's centre point [m/s].
    turning : float
        Greatest rate of reorientation [rad/s].
    rate : float
        Greatest rate along the curve's own length [m/s]: what a duration asks for.
    acceleration : float
        Share of the arm's accelerations, 0 to 1.
    ramp : float
        Share of the arm's jerk, 0 to 1.
    tool_acceleration : float
        Greatest acceleration of the tool along the path [m/s^2].
    """

    speed: float = math.inf
    turning: float = math.inf
    rate: float = math.inf
    acceleration: float = 1.0
    ramp: float = 1.0
    tool_acceleration: float = math.inf


class Sampled:
    """Angles, positions and orientations over a stretch of path, as one spline.

    Parameters
    ----------
    x
        Distances (n,), equally spaced.
    joints
        Angles (n, 6) [rad].
    positions, orientations
        Poses of the tool (n, 3) and (n, 4).
    """

    def __init__(self, x: Array, joints: Array, positions: Array, orientations: Array) -> None:
        self.x = x
        self.joints = joints
        self._values = np.concatenate([joints, positions, continuous(orientations)], axis=1)
        self._step = float(x[-1] - x[0]) / (len(x) - 1)
        self._slopes = np.empty_like(self._values)
        spline_slopes(self._step, self._values, self._slopes)

    def _evaluate(self, x: Array) -> tuple[Array, Array, Array]:
        out, first, second = (np.empty((len(x), self._values.shape[1])) for _ in range(3))
        spline_values(float(self.x[0]), self._step, self._values, self._slopes, x, out, first, second)
        return out, first, second

    def derivatives(self, x: Array) -> tuple[Array, Array, Array, Array, Array]:
        """Return q (n, 6), q', q'', and the rates of translation (n,) and rotation (n,) [rad/m]."""
        values, first, second = self._evaluate(x)
        speed = np.sqrt(np.square(first[:, 6:9]).sum(axis=1))
        turning = 2.0 * np.sqrt(np.square(first[:, 9:]).sum(axis=1))
        return values[:, :6], first[:, :6], second[:, :6], speed, turning

    def joints_at(self, x: Array) -> Array:
        """Return angles (n, 6)."""
        return self._evaluate(x)[0][:, :6]

    def positions_at(self, x: Array) -> Array:
        """Return positions of the tool (n, 3) [m]."""
        return self._evaluate(x)[0][:, 6:9]

    @property
    def positions(self) -> Array:
        """Return the positions of the tool (n, 3) at the distances `x` [m]."""
        return self.positions_at(self.x)


def sample_tool_path(arm: Arm, tool: Array, poses: PoseFunction, x0: float, x1: float, start: Array) -> Sampled:
    """Sample a path of the tool between two distances, beginning nearest to some angles (6,).

    Raises
    ------
    MotionFault
        As `branches.follow`.
    """
    _, some = poses(np.linspace(x0, x1, _FEWEST))
    turned = float(2.0 * np.arccos(np.minimum(np.abs(np.sum(some[1:] * some[:-1], axis=1)), 1.0)).sum())
    x = np.linspace(x0, x1, _count(x1 - x0, turned))
    positions, orientations = poses(x)
    return Sampled(x, follow(arm, flange_poses(positions, orientations, tool), start), positions, orientations)


def sample_joint_path(arm: Arm, tool: Array, joints: Callable[[Array], Array], x0: float, x1: float) -> Sampled:
    """Sample a path of the joints between two distances.

    Raises
    ------
    MotionFault
        Where it leaves the range of an axis.
    """
    ends = joints(np.array([x0, x1]))
    x = np.linspace(x0, x1, _count(0.0, float(np.abs(ends[1] - ends[0]).max())))
    angles = joints(x)
    check_ranges(arm, angles)
    poses = forward(arm, angles) @ tool
    return Sampled(x, angles, poses[:, :3, 3], Rotation.from_matrix(poses[:, :3, :3]).as_quat())


def sample_wrist_path(arm: Arm, tool: Array, curve: Line | Circle, start: Array, end: Array) -> Sampled:
    """Sample a curve on which axes 4 to 6 move in proportion, and axes 1 to 3 keep the tool on the curve.

    The orientation is that of the curve at its ends only; a singularity of the wrist does not matter.

    Raises
    ------
    MotionFault
        Where the curve is out of reach, or leaves the range of an axis.
    """
    ends = curve.poses(np.array([0.0, curve.length]))[1]
    turned = float(np.abs(end - start)[3:].max() + math.acos(min(1.0, abs(float(ends[0] @ ends[1])))))
    x = np.linspace(0.0, curve.length, _count(curve.length, turned))
    share = (x / curve.length)[:, None]
    wanted, angles = curve.poses(x)[0], start + share * (end - start)
    for _ in range(_NEWTON_STEPS):
        errors = wanted - (forward(arm, angles) @ tool)[:, :3, 3]
        if np.abs(errors).max() < _NEWTON_TOLERANCE:
            break
        columns = []
        for axis in range(3):
            moved = angles.copy()
            moved[:, axis] += _DIFFERENCE
            columns.append(((forward(arm, moved) @ tool)[:, :3, 3] - wanted + errors) / _DIFFERENCE)
        jacobians = np.stack(columns, axis=-1) + 1e-12 * np.eye(3)
        angles[:, :3] += np.linalg.solve(jacobians, errors[..., None])[..., 0]
    else:
        raise MotionFault(OUT_OF_REACH, f"{arm.title} does not reach all points of the way with SingArea \\Wrist")
    check_ranges(arm, angles)
    poses = forward(arm, angles) @ tool
    return Sampled(x, angles, poses[:, :3, 3], Rotation.from_matrix(poses[:, :3, :3]).as_quat())


def _count(length: float, turned: float) -> int:
    return int(min(max(math.ceil(length / _STEP), math.ceil(turned / _TURN_STEP), _FEWEST), _MOST))


@dataclass
class Piece:
    """Stretch of the path with one spline and one movement's limits.

    Attributes
    ----------
    sampled : Sampled
        The spline.
    offset : float
        Position on the whole path of the spline's distance 0 [m].
    s : array of shape (n,)
        Points at which the limits are kept, on the whole path [m].
    limits : Limits
        Limits of the movement.
    arm : Arm
        The arm.
    caps, first, second, accelerations : arrays
        Greatest x by limits of speed (n,), derivatives and limits of acceleration (n, 7); see `timing_kernels`.
    unreduced : array of shape (7,)
        Limits of acceleration of the movement.
    slowing : array of shape (n,)
        Share of the caps that keeps the limits after the mean too; `accelerations` are reduced for that as well.
    """

    sampled: Sampled
    offset: float
    s: Array
    limits: Limits
    arm: Arm
    caps: Array = field(init=False)
    first: Array = field(init=False)
    second: Array = field(init=False)
    accelerations: Array = field(init=False)
    unreduced: Array = field(init=False)
    slowing: Array = field(init=False)

    def __post_init__(self) -> None:
        """Compute the derivatives and the limits at the points."""
        self.first, self.second, self.caps = self.rows_at(self.s)
        limits = self.limits
        self.unreduced = np.append(self.arm.accelerations * limits.acceleration, min(limits.tool_acceleration, 1e9))
        self.accelerations = np.tile(self.unreduced, (len(self.s), 1))
        self.slowing = np.ones(len(self.s))

    def rows_at(self, s: Array) -> tuple[Array, Array, Array]:
        """Return the first and second derivatives (n, 7) of angles and way, and the greatest x by speed limits (n,)."""
        _, first, second, speed, turning = self.sampled.derivatives(s - self.offset)
        greatest = np.maximum((np.abs(first) / self.arm.speeds).max(axis=1), _SMALL)
        limits = self.limits
        for way, limit in ((speed, limits.speed), (turning, limits.turning), (np.ones(len(s)), limits.rate)):
            if math.isfinite(limit):
                greatest = np.maximum(greatest, way / limit)
        rows = np.concatenate([first, speed[:, None]], axis=1)
        return rows, np.concatenate([second, np.zeros((len(s), 1))], axis=1), 1.0 / greatest**2

    @property
    def start(self) -> float:
        """Return where it begins on the whole path [m]."""
        return float(self.s[0])

    @property
    def end(self) -> float:
        """Return where it ends on the whole path [m]."""
        return float(self.s[-1])

    def split(self, position: float) -> list[Piece]:
        """Return the parts of it before and behind a position on the whole path."""
        parts = []
        for inside in (self.s < position - 1e-9, self.s > position + 1e-9):
            s = self.s[inside]
            s = np.append(s, position) if s[0] < position else np.append(position, s)
            parts.append(Piece(self.sampled, self.offset, s, self.limits, self.arm))
            parts[-1].slowing = np.interp(s, self.s, self.slowing)
            parts[-1].accelerations *= parts[-1].slowing[:, None]
        return parts


def piece_between(sampled: Sampled, offset: float, x0: float, x1: float, limits: Limits, arm: Arm) -> Piece:
    """Return the piece between two distances of a stretch, with the stretch's own points inside."""
    gap = 0.05 * (x1 - x0) / _FEWEST
    inside = sampled.x[(sampled.x > x0 + gap) & (sampled.x < x1 - gap)]
    if len(inside) < _FEWEST - 2:
        inside = np.linspace(x0, x1, _FEWEST)[1:-1]
    return Piece(sampled, offset, offset + np.concatenate([[x0], inside, [x1]]), limits, arm)


def sample_curve(arm: Arm, tool: Array, curve: Curve, start: Array) -> Sampled:
    """Sample a whole curve, beginning nearest to some angles (6,).

    Raises
    ------
    MotionFault
        As `branches.follow`.
    """
    if isinstance(curve, JointCurve):
        return sample_joint_path(arm, tool, curve.joints, 0.0, curve.length)
    return sample_tool_path(arm, tool, curve.poses, 0.0, curve.length, start)
