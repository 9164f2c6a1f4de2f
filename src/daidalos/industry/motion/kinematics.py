"""Kinematics of arms with a spherical wrist, in closed form, over arrays.

The inverse finds the centre of the wrist first, then axes 1 to 3 in the plane of the arm by the law of cosines, then
axes 4 to 6 from the rotation that is left (Pieper, "The Kinematics of Manipulators under Computer Control", 1968). A
pose has up to eight solutions; solution `n` is the one for which ABB's `cfx` is `n`:

======  ================  ==================  ========
cfx     wrist to axis 1   wrist to lower arm  axis 5
======  ================  ==================  ========
0, 1    in front          in front            +, -
2, 3    in front          behind              +, -
4, 5    behind            in front            +, -
6, 7    behind            behind              +, -
======  ================  ==================  ========

"In front" and "behind" are meant in the frame that turns with axis 1 and, for the lower arm, with axis 2.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import IntFlag

import numpy as np
from numpy.typing import NDArray

from daidalos.industry.motion.kinematics_kernels import forward_kernel, inverse_kernel
from daidalos.industry.robots.arm import Arm

_QUADRANT = 0.5 * math.pi
_QUADRANT_TOLERANCE = 1e-9
"""Angle [rad] below a quadrant's beginning that counts as in it: zero as a computer finds it may be -1e-17."""

_BORDER_TOLERANCE = 1e-3
"""Angle [rad] by which an axis may miss the quadrant that a configuration names: positions in programs are rounded."""


class Singularity(IntFlag):
    """Singularities in which, or near which, joint angles are.

    `WRIST`: axes 4 and 6 are on one line. `ELBOW`: the arm is stretched or folded, the centre of the wrist is in line
    with axes 2 and 3. `SHOULDER`: the centre of the wrist is on axis 1.
    """

    WRIST = 1
    ELBOW = 2
    SHOULDER = 4


class JointRangeError(ValueError):
    """Angle outside of the range of its axis."""


@dataclass(frozen=True)
class Solutions:
    """Solutions of the inverse kinematics, in the order of `cfx`.

    Attributes
    ----------
    joints : array of shape (..., 8, 6)
        Angles [rad], each with the whole turns that put it nearest to the middle of its range; NaN where the pose is
        out of reach with that `cfx`. In a singularity the angle that is free is zero: axis 1 in that of the shoulder,
        axis 4 in that of the wrist, before turns; the two solutions that meet there are then the same.
    within_limits : array of bool of shape (..., 8)
        Whether all angles are within their ranges.
    """

    joints: NDArray[np.float64]
    within_limits: NDArray[np.bool_]

    @property
    def reachable(self) -> NDArray[np.bool_]:
        """Return which solutions exist, within limits or not, an array of shape (..., 8)."""
        return np.isfinite(self.joints[..., 0])


def forward(arm: Arm, joints: NDArray[np.float64]) -> NDArray[np.float64]:
    """Compute the poses of tool0 in the base.

    Parameters
    ----------
    arm : Arm
        The arm.
    joints : array of shape (..., 6)
        Angles [rad].

    Returns
    -------
    array of shape (..., 4, 4)
    """
    angles = _joints(joints)
    out = np.empty((angles.size // 6, 4, 4))
    forward_kernel(angles.reshape(-1, 6), arm.dimensions, out)
    return out.reshape(*angles.shape[:-1], 4, 4)


def inverse(arm: Arm, poses: NDArray[np.float64]) -> Solutions:
    """Compute all solutions of poses of tool0 in the base.

    Parameters
    ----------
    arm : Arm
        The arm.
    poses : array of shape (..., 4, 4)
        Rigid transformations.

    Raises
    ------
    ValueError
        Where a matrix is no rigid transformation.
    """
    matrices = np.ascontiguousarray(poses, dtype=np.float64)
    if matrices.ndim < 2 or matrices.shape[-2:] != (4, 4):
        raise ValueError(f"poses have the shape {matrices.shape}, but (..., 4, 4) is needed")
    count = matrices.size // 16
    joints, within = np.empty((count, 8, 6)), np.empty((count, 8), dtype=np.bool_)
    wrong = inverse_kernel(matrices.reshape(-1, 4, 4), arm.dimensions, arm.limits, joints, within)
    if wrong >= 0:
        raise ValueError(f"pose {wrong} is no rotation with a finite translation and the last row 0 0 0 1")
    shape = matrices.shape[:-2]
    return Solutions(joints.reshape(*shape, 8, 6), within.reshape(*shape, 8))


def within_limits(arm: Arm, joints: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return which joint angles (..., 6) are within their ranges, as (...)."""
    angles, limits = _joints(joints), arm.limits
    inside: NDArray[np.bool_] = np.all((angles >= limits[:, 0]) & (angles <= limits[:, 1]), axis=-1)
    return inside


def confdata(arm: Arm, joints: NDArray[np.float64]) -> NDArray[np.int64]:
    """Compute ABB's configuration data of joint angles.

    Parameters
    ----------
    arm : Arm
        The arm.
    joints : array of shape (..., 6)
        Angles [rad], all finite.

    Returns
    -------
    array of shape (..., 4)
        cf1, cf4 and cf6, the quarter turns of axes 1, 4 and 6 (0 for 0 to 90 degrees, -1 for -90 to 0), and cfx.
    """
    angles = _joints(joints)
    if not np.isfinite(angles).all():
        raise ValueError("joint angles are not finite: an unreachable solution has no configuration")
    quarters = np.floor((angles[..., [0, 3, 5]] + _QUADRANT_TOLERANCE) / _QUADRANT)
    behind = _wrist_radius(arm, angles) < 0.0
    over = np.sin(_elbow_angle(arm, angles)) < 0.0
    down = np.sin(angles[..., 4]) < 0.0
    cfx = 4 * behind + 2 * over + 1 * down
    return np.concatenate([quarters, cfx[..., None]], axis=-1).astype(np.int64)


def joints_of_configuration(
    arm: Arm, pose: NDArray[np.float64], configuration: tuple[int, int, int, int]
) -> NDArray[np.float64]:
    """Return the angles of one pose (4, 4) with cf1, cf4, cf6 and cfx, the whole turns of axes 1, 4 and 6 included.

    Raises
    ------
    ValueError
        Where cfx is none of 0 to 7, the pose is out of reach with it, its angles lie in other quadrants than cf1, cf4
        and cf6 say (by more than 1e-3 rad); the message names which.
    JointRangeError
        Where an angle is outside the limits.
    """
    cfx = configuration[3]
    if cfx not in range(8):
        raise ValueError(f"cfx is {cfx}, but must be 0 to 7")
    angles: NDArray[np.float64] = inverse(arm, np.asarray(pose, dtype=np.float64).reshape(4, 4)).joints[cfx]
    if not np.isfinite(angles).all():
        raise ValueError(f"the pose is out of reach of {arm.title} with cfx {cfx}")
    found = confdata(arm, angles)
    for number, (axis, wanted) in enumerate(zip((0, 3, 5), configuration[:3], strict=True)):
        start = wanted * _QUADRANT - _BORDER_TOLERANCE
        past = (angles[axis] - start) % (4.0 * _QUADRANT)
        if past > _QUADRANT + 2.0 * _BORDER_TOLERANCE:
            raise ValueError(
                f"axis {axis + 1} is at {math.degrees(angles[axis]):.3f} deg with cfx {cfx}: "
                f"quadrant {found[number]}, where cf{axis + 1} is {wanted}"
            )
        angles[axis] = start + past
    for number, (angle, axis_limits) in enumerate(zip(angles, arm.axes, strict=True), 1):
        if not axis_limits.lower <= angle <= axis_limits.upper:
            raise JointRangeError(
                f"axis {number} would be at {math.degrees(angle):.3f} deg, outside "
                f"{math.degrees(axis_limits.lower):g} to {math.degrees(axis_limits.upper):g} deg"
            )
    return angles


def singularities(
    arm: Arm, joints: NDArray[np.float64], angle: float = 1e-4, distance: float = 1e-4
) -> NDArray[np.int64]:
    """Return in which singularities joint angles are, as values of `Singularity`.

    Parameters
    ----------
    arm : Arm
        The arm.
    joints : array of shape (..., 6)
        Angles [rad].
    angle : float
        Angle up to which axes 4 and 6, or lower arm and wrist, count as in line [rad].
    distance : float
        Distance up to which the centre of the wrist counts as on axis 1 [m].
    """
    angles = _joints(joints)
    wrist = np.abs(np.sin(angles[..., 4])) <= math.sin(angle)
    elbow = np.abs(np.sin(_elbow_angle(arm, angles))) <= math.sin(angle)
    shoulder = np.abs(_wrist_radius(arm, angles)) <= distance
    return np.asarray(
        wrist * int(Singularity.WRIST) + elbow * int(Singularity.ELBOW) + shoulder * int(Singularity.SHOULDER),
        dtype=np.int64,
    )


def _joints(joints: NDArray[np.float64]) -> NDArray[np.float64]:
    angles = np.ascontiguousarray(joints, dtype=np.float64)
    if angles.ndim < 1 or angles.shape[-1] != 6:
        raise ValueError(f"joint angles have the shape {angles.shape}, but (..., 6) is needed")
    return angles


def _elbow_angle(arm: Arm, angles: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the angle [rad] of the wrist about axis 3, from in line with the lower arm forwards."""
    return angles[..., 2] + 0.5 * math.pi - math.atan2(arm.elbow_offset, arm.forearm)


def _wrist_radius(arm: Arm, angles: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how far the centre of the wrist is in front of axis 1 [m]."""
    pitch = angles[..., 1] + angles[..., 2]
    radius: NDArray[np.float64] = (
        arm.shoulder_offset
        + arm.lower_arm * np.sin(angles[..., 1])
        + arm.elbow_offset * np.sin(pitch)
        + arm.forearm * np.cos(pitch)
    )
    return radius
