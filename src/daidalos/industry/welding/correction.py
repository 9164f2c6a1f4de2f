"""Correction of paths: the programmed path on which the loaded tool runs along the desired one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.errors import UserError
from daidalos.industry.elasticity.deflection import Loaded, Options, flanks_at, load
from daidalos.industry.elasticity.elasticity import Elasticity
from daidalos.industry.motion.kinematics import inverse
from daidalos.industry.robots.arm import Arm
from daidalos.industry.welding.bsplines import PathSpline, fit_path
from daidalos.industry.welding.joint_paths import check_speeds, choose_branch, joint_speeds
from daidalos.industry.welding.seam import path_lengths

TOLERANCE = 1e-6
"""Distance of the loaded tool from the desired path at which the iteration ends [m], and its angle [rad]."""
MAX_ITERATIONS = 30

_TURN = 2.0 * np.pi


@dataclass(frozen=True)
class Cell:
    """What a path is corrected for.

    Attributes
    ----------
    arm, elasticity : Arm, Elasticity
        The robot; the elasticity holds the mass of its tool.
    tool : array of shape (4, 4)
        Pose of the tool's centre point in tool0.
    options : Options
        What counts for the deflection.
    """

    arm: Arm
    elasticity: Elasticity
    tool: NDArray[np.float64]
    options: Options


@dataclass(frozen=True)
class Correction:
    """A corrected path.

    Attributes
    ----------
    desired, programmed : array of shape (n, 4, 4)
        Poses of the tool: those wanted, and those that the splines of the corrected path have.
    before, after : Loaded
        State of the arm under load on the desired path as programmed, and on the corrected one.
    distances : array of shape (n,)
        Length of the desired path [m].
    motors : array of shape (n, 6)
        Angles of the motors on the programmed path [rad].
    branch : int
        ABB's `cfx` of the angles.
    convergence : tuple of (float, float)
        Greatest distance [m] and angle [rad] of the loaded tool from the desired path after each iteration.
    spline : PathSpline
        Of the programmed path.
    """

    desired: NDArray[np.float64]
    programmed: NDArray[np.float64]
    before: Loaded
    after: Loaded
    distances: NDArray[np.float64]
    motors: NDArray[np.float64]
    branch: int
    convergence: tuple[tuple[float, float], ...]
    spline: PathSpline


def correct(
    cell: Cell,
    desired: NDArray[np.float64],
    wrenches: NDArray[np.float64],
    speed: float | NDArray[np.float64],
    title: str = "path",
) -> Correction:
    """Compute the programmed path by fixed-point iteration.

    Each iteration loads the arm on the programmed path and moves every programmed pose by what the loaded tool is away
    from the desired one; transmissions lie on the flanks on which they do once the tool is there. The result is
    smoothed by B-splines, which are parted where a transmission changes its flank or friction its direction.

    Parameters
    ----------
    cell : Cell
        The robot and its tool.
    desired : array of shape (n, 4, 4)
        Poses of the tool in the base.
    wrenches : array of shape (n, 6)
        That the tool exerts on the workpiece, in the tool's axes [N, Nm].
    speed : float or array of shape (n,)
        Of the tool along the path [m/s].
    title : str
        Name of the path in messages.

    Raises
    ------
    UserError
        Where the path cannot be followed, or the iteration does not converge.
    """
    flange = np.linalg.inv(cell.tool)
    joints, branch = choose_branch(cell.arm, desired @ flange, title)
    distances = path_lengths(desired[:, :3, 3])
    speeds = joint_speeds(joints, distances, speed)
    check_speeds(cell.arm, speeds, title)
    programmed, motors = desired, joints
    convergence = []
    before = loaded = _load(cell, motors, wrenches, speeds, title)
    # Where a torque is nearly zero, the correction for one flank could bring the transmission onto the other, and back.
    sides = flanks_at(cell.arm, cell.elasticity, joints, cell.tool, wrenches, speeds, cell.options)
    for _ in range(MAX_ITERATIONS):
        away, turned = pose_errors(desired, loaded.poses)
        convergence.append((float(np.linalg.norm(away, axis=1).max()), float(np.linalg.norm(turned, axis=1).max())))
        if max(convergence[-1]) < TOLERANCE:
            break
        programmed = moved(programmed, away, turned)
        motors = _follow(cell.arm, programmed @ flange, branch, motors, title)
        loaded = _load(cell, motors, wrenches, speeds, title, sides)
    else:
        raise UserError(
            f"{title}: the correction does not converge: {1e3 * convergence[-1][0]:.4f} mm are left after "
            f"{MAX_ITERATIONS} iterations"
        )
    breaks = _changes(loaded.sides)
    if cell.options.friction:
        breaks += _changes(np.sign(speeds))
    spline = fit_path(distances, programmed, breaks)
    motors = _follow(cell.arm, spline.poses @ flange, branch, motors, title)
    after = _load(cell, motors, wrenches, speeds, title, sides)
    return Correction(desired, spline.poses, before, after, distances, motors, branch, tuple(convergence), spline)


def pose_errors(
    desired: NDArray[np.float64], actual: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return what leads from actual poses to desired ones: translations (n, 3) [m], rotation vectors (n, 3) [rad]."""
    from scipy.spatial.transform import Rotation

    turn = desired[:, :3, :3] @ np.swapaxes(actual[:, :3, :3], 1, 2)
    return desired[:, :3, 3] - actual[:, :3, 3], Rotation.from_matrix(turn).as_rotvec()


def moved(
    poses: NDArray[np.float64], translations: NDArray[np.float64], rotations: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return poses (n, 4, 4) after translations (n, 3) [m] and rotation vectors (n, 3) [rad] in the base."""
    from scipy.spatial.transform import Rotation

    out = poses.copy()
    out[:, :3, 3] += translations
    out[:, :3, :3] = (Rotation.from_rotvec(rotations) * Rotation.from_matrix(poses[:, :3, :3])).as_matrix()
    return out


def deviations(
    desired: NDArray[np.float64], actual: NDArray[np.float64], axes: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return how far poses (n, 4, 4) are from desired ones ahead, across and along the tool (n, 3) [m].

    `axes` (n, 3, 3) are those of `daidalos.industry.welding.seam.tool_axes`.
    """
    return in_axes(axes, actual[:, :3, 3] - desired[:, :3, 3])


def in_axes(axes: NDArray[np.float64], vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return vectors (n, 3) of the base in axes (n, 3, 3)."""
    turned: NDArray[np.float64] = np.einsum("nji,nj->ni", axes, vectors)
    return turned


def _load(
    cell: Cell,
    motors: NDArray[np.float64],
    wrenches: NDArray[np.float64],
    speeds: NDArray[np.float64],
    title: str,
    sides: NDArray[np.float64] | None = None,
) -> Loaded:
    try:
        return load(cell.arm, cell.elasticity, motors, cell.tool, wrenches, speeds, cell.options, sides=sides)
    except ValueError as error:
        raise UserError(f"{title}: {error}") from None


def _follow(
    arm: Arm, flanges: NDArray[np.float64], branch: int, near: NDArray[np.float64], title: str
) -> NDArray[np.float64]:
    """Return the angles of one branch, each with the whole turns that put it nearest to known angles (n, 6)."""
    joints = inverse(arm, flanges).joints[:, branch]
    joints = joints - _TURN * np.round((joints - near) / _TURN)
    inside = np.isfinite(joints).all(axis=1)
    inside &= ((joints >= arm.limits[:, 0]) & (joints <= arm.limits[:, 1])).all(axis=1)
    if not inside.all():
        raise UserError(f"{title}: point {int(np.argmin(inside)) + 1} is out of reach once it is corrected")
    return joints


def _changes(signs: NDArray[np.float64]) -> list[int]:
    """Return the points at which a sign of (n, 6) differs from the one before it."""
    return [int(one) + 1 for one in np.flatnonzero((np.diff(signs, axis=0) != 0.0).any(axis=1))]
