"""Kinematics of arms with seven axes, over arrays.

The redundant axis is described by the arm angle that ABB's controllers print: the angle about the line from shoulder
to wrist of the plane through it and the elbow, with the direction of the elbow's axis for that of the elbow (Elias and
Wen, "Redundancy Parameterization of the ABB YuMi Robot Arm", 2025). It counts from the z axis of the base.

There is no closed form for such arms. The inverse makes damped Newton steps within the ranges of the axes, from several
beginnings.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daidalos.industry.motion.redundant_kernels import forward_redundant, solve_redundant
from daidalos.industry.robots.redundant import AXES, RedundantArm

Array = NDArray[np.float64]

TOLERANCE = 1e-10
"""Deviation of a solution from its pose [m], [rad] times 0.1 m."""

_SCALE = 0.1
"""Length [m] that makes a turn comparable with a distance."""

_SEEDS = 40


def forward_of(arm: RedundantArm, joints: Array) -> tuple[Array, Array]:
    """Compute the poses of tool0 in the base, and the arm angles.

    Parameters
    ----------
    arm : RedundantArm
        The arm.
    joints : array of shape (..., 7)
        Angles from the base on [rad].

    Returns
    -------
    poses : array of shape (..., 4, 4)
    arm_angles : array of shape (...)
        [rad], from -pi to pi; NaN where the wrist is above the shoulder, in line with axis 1.
    """
    angles = _joints(joints)
    count = angles.size // AXES
    poses, arm_angles = np.empty((count, 4, 4)), np.empty(count)
    forward_redundant(angles.reshape(-1, AXES), arm.geometry, _places(arm), poses, arm_angles)
    shape = angles.shape[:-1]
    return poses.reshape(*shape, 4, 4), arm_angles.reshape(shape)


def inverse_of(
    arm: RedundantArm, poses: Array, arm_angles: Array | float | None = None, near: Array | None = None
) -> Array:
    """Find joint angles of poses of tool0 in the base.

    Parameters
    ----------
    arm : RedundantArm
        The arm.
    poses : array of shape (..., 4, 4)
        Rigid transformations.
    arm_angles : array of shape (...) or float or None
        Arm angles [rad]; without them the arm is free to choose.
    near : array of shape (..., 7) or None
        Angles [rad] to begin with: the solution is usually the nearest one.

    Returns
    -------
    array of shape (..., 7)
        Angles within the ranges, whose pose is exact to `TOLERANCE`; NaN where none was found. That no solution is
        found is no proof that there is none.

    Raises
    ------
    ValueError
        Where shapes do not fit, or a pose is no rigid transformation.
    """
    matrices = np.ascontiguousarray(poses, dtype=np.float64)
    if matrices.ndim < 2 or matrices.shape[-2:] != (4, 4):
        raise ValueError(f"poses have the shape {matrices.shape}, but (..., 4, 4) is needed")
    shape = matrices.shape[:-2]
    flat = matrices.reshape(-1, 4, 4)
    _check(flat)
    wanted = np.full(shape, np.nan if arm_angles is None else 0.0)
    if arm_angles is not None:
        wanted = wanted + np.asarray(arm_angles, dtype=np.float64)
        if wanted.shape != shape or not np.isfinite(wanted).all():
            raise ValueError(f"arm angles must be finite and of the shape {shape}")
    out = np.empty((len(flat), AXES))
    solve_redundant(
        flat,
        wanted.reshape(-1),
        _seeds(arm, shape, near),
        arm.geometry,
        _places(arm),
        arm.limits,
        _SCALE,
        TOLERANCE,
        out,
    )
    return out.reshape(*shape, AXES)


def within_ranges(arm: RedundantArm, joints: Array) -> NDArray[np.bool_]:
    """Return which joint angles (..., 7) are within their ranges, as (...)."""
    angles, limits = _joints(joints), arm.limits
    inside: NDArray[np.bool_] = np.all((angles >= limits[:, 0]) & (angles <= limits[:, 1]), axis=-1)
    return inside


def _check(flat: Array) -> None:
    with np.errstate(invalid="ignore"):
        products = np.abs(flat[:, :3, :3].transpose(0, 2, 1) @ flat[:, :3, :3] - np.eye(3)).max(axis=(1, 2))
        wrong = ~(np.isfinite(flat).all(axis=(1, 2)) & (products < 1e-6) & (np.linalg.det(flat[:, :3, :3]) > 0.0))
    if wrong.any():
        number = int(np.flatnonzero(wrong)[0])
        raise ValueError(f"pose {number} is no rotation with a finite translation and the last row 0 0 0 1")


def _seeds(arm: RedundantArm, shape: tuple[int, ...], near: Array | None) -> Array:
    """Return the beginnings of each pose (N, M, 7): that which is near, and points spread over the ranges."""
    middle = arm.limits.mean(axis=1)
    half = 0.4 * (arm.limits[:, 1] - arm.limits[:, 0])
    spread = middle + half * np.random.default_rng(7).uniform(-1.0, 1.0, (_SEEDS, AXES))
    spread[0] = middle
    count = int(np.prod(shape, dtype=np.int64))
    seeds = np.broadcast_to(spread, (count, _SEEDS, AXES))
    if near is None:
        return np.ascontiguousarray(seeds)
    first = np.broadcast_to(np.asarray(near, dtype=np.float64), (*shape, AXES)).reshape(count, 1, AXES)
    if not np.isfinite(first).all():
        raise ValueError("the angles to begin with are not finite")
    return np.concatenate([np.clip(first, *arm.limits.T), seeds], axis=1)


def _joints(joints: Array) -> Array:
    angles = np.ascontiguousarray(joints, dtype=np.float64)
    if angles.ndim < 1 or angles.shape[-1] != AXES:
        raise ValueError(f"joint angles have the shape {angles.shape}, but (..., {AXES}) is needed")
    return angles


def _places(arm: RedundantArm) -> Array:
    return np.array([arm.elbow_axis, arm.wrist_axis], dtype=np.float64)
