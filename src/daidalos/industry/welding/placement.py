"""Choice of the rotation about the tool's axis and of the workpiece's place by the stiffness of the arm."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from daidalos.industry.elasticity.deflection import deflections, transmission_torques, windings
from daidalos.industry.welding.correction import Cell
from daidalos.industry.welding.joint_paths import branches, margin

SAMPLES = 25
"""Points of a path that are looked at."""
SHIFTS = np.arange(-0.6, 0.61, 0.1)
"""Shifts of the workpiece ahead and to the left that are tried [m]."""
ROTATIONS = np.radians(np.arange(-180.0, 180.0, 15.0))
"""Rotations about the tool's axis that are tried [rad]."""


@dataclass(frozen=True)
class Candidate:
    """A choice that was tried.

    Attributes
    ----------
    value : tuple of float
        Shift [m], or rotation [rad].
    deflection : float
        Root mean square of the distance by which the tool stays behind [m]; infinite where the arm cannot follow.
    """

    value: tuple[float, ...]
    deflection: float


def rotate_about_tool(poses: NDArray[np.float64], angle: float) -> NDArray[np.float64]:
    """Return poses (n, 4, 4) turned about their z axes [rad]."""
    c, s = np.cos(angle), np.sin(angle)
    turn = np.eye(4)
    turn[:2, :2] = [[c, -s], [s, c]]
    return poses @ turn


def try_rotations(
    cell: Cell, poses: NDArray[np.float64], axes: NDArray[np.float64], wrenches: NDArray[np.float64]
) -> list[Candidate]:
    """Return the rotations about the tool's axis that were tried, that with the least deflection first.

    Parameters
    ----------
    cell : Cell
        The robot and its tool.
    poses : array of shape (n, 4, 4)
        Desired, without rotation.
    axes : array of shape (n, 3, 3)
        Axes of the wrenches.
    wrenches : array of shape (n, 6)
        [N, Nm]
    """
    some = _samples(len(poses))
    tried = [
        Candidate(
            (float(angle),), deflection_of(cell, rotate_about_tool(poses[some], angle), axes[some], wrenches[some])
        )
        for angle in ROTATIONS
    ]
    return sorted(tried, key=lambda one: one.deflection)


def try_places(
    cell: Cell, poses: NDArray[np.float64], axes: NDArray[np.float64], wrenches: NDArray[np.float64]
) -> list[Candidate]:
    """Return the shifts of the workpiece in the plane of the floor that were tried, the stiffest place first."""
    some = _samples(len(poses))
    tried = []
    for x in SHIFTS:
        for y in SHIFTS:
            moved = poses[some].copy()
            moved[:, :2, 3] += (x, y)
            tried.append(Candidate((float(x), float(y)), deflection_of(cell, moved, axes[some], wrenches[some])))
    return sorted(tried, key=lambda one: one.deflection)


def deflection_of(
    cell: Cell, poses: NDArray[np.float64], axes: NDArray[np.float64], wrenches: NDArray[np.float64]
) -> float:
    """Return the root mean square of the deflection [m] with the axes wound by the load; infinite out of reach."""
    joints, usable, _ = branches(cell.arm, poses @ np.linalg.inv(cell.tool))
    if not usable:
        return float("inf")
    chosen = joints[max(usable, key=lambda branch: margin(cell.arm, joints[branch]))]
    turned = np.concatenate([np.einsum("nij,nj->ni", axes, wrenches[:, part]) for part in (slice(3), slice(3, 6))], 1)
    options = replace(cell.options, friction=False)
    points = poses[:, :3, 3]
    torques = transmission_torques(cell.arm, cell.elasticity, chosen, points, turned, np.zeros_like(chosen), options)
    wound, _ = windings(cell.elasticity, torques, options)
    behind = deflections(cell.arm, chosen, points, wound)[:, :3]
    return float(np.sqrt((behind**2).sum(axis=1).mean()))


def _samples(count: int) -> NDArray[np.int64]:
    return np.unique(np.linspace(0, count - 1, min(count, SAMPLES)).astype(np.int64))
