"""Load tests of arms: joint angles, loads, and the measured places of the loaded tool."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from daidalos.common.documents import DocumentError
from daidalos.industry.columns import read_columns
from daidalos.industry.elasticity.elasticity import Elasticity
from daidalos.industry.elasticity.jacobians import jacobians
from daidalos.industry.motion.kinematics import forward, singularities
from daidalos.industry.robots.arm import Arm

JOINTS = tuple(f"joint_{number}_deg" for number in range(1, 7))
WRENCH = ("fx", "fy", "fz", "mx", "my", "mz")
PLACE = ("x_mm", "y_mm", "z_mm")
CANDIDATES = 400
"""Random poses that the design chooses from."""
FRICTION_MARGIN = 1.5
"""Torque, in multiples of Coulomb friction, above which it is known on which flank a transmission lies."""
MIN_INFORMATION = 1e-6
"""Least eigenvalue of the information, as a share of that of all candidates, at which all parameters can be told."""
FLOOR = 0.3
"""Least height of the tool [m]."""
REACH_SHARE = 0.95


@dataclass(frozen=True)
class LoadTest:
    """Loads on an arm, and what they did.

    Attributes
    ----------
    poses : array of int of shape (n,)
        Number of the pose; the arm's motors stay at one pose while its loads change.
    joints : array of shape (n, 6)
        Angles of the motors [rad].
    wrenches : array of shape (n, 6)
        That the tool exerts at its centre point, in the axes of the base [N, Nm].
    places : array of shape (n, 3) or None
        Measured places of the tool's centre point in the base [m].
    """

    poses: NDArray[np.int64]
    joints: NDArray[np.float64]
    wrenches: NDArray[np.float64]
    places: NDArray[np.float64] | None = None


def read_load_test(path: Path, measured: bool) -> LoadTest:
    """Return the load test in a CSV file, with measured places or without.

    The columns are ``pose``, ``joint_1_deg`` to ``joint_6_deg``, ``fx, fy, fz, mx, my, mz``, and ``x_mm, y_mm, z_mm``.

    Raises
    ------
    DocumentError
        Where it is none; the message names line and column.
    """
    needed = ("pose", *JOINTS, *WRENCH, *(PLACE if measured else ()))
    columns, lines, _ = read_columns(path, ("pose", *JOINTS, *WRENCH, *PLACE))
    for name in needed:
        if name not in columns:
            raise DocumentError(f"has no column '{name}'", str(path), 1)
    if not lines:
        raise DocumentError("has no rows", str(path))
    stacked = [np.stack([columns[name] for name in names], axis=1) for names in (JOINTS, WRENCH)]
    places = 1e-3 * np.stack([columns[name] for name in PLACE], axis=1) if measured else None
    poses = columns["pose"].astype(np.int64)
    joints = np.radians(stacked[0])
    for number in np.unique(poses):
        rows = np.flatnonzero(poses == number)
        if np.ptp(joints[rows], axis=0).max() > 1e-6:
            raise DocumentError(f"pose {number} has rows with other angles", str(path), lines[int(rows[1])])
    return LoadTest(poses, joints, stacked[1], places)


def as_csv(test: LoadTest) -> str:
    """Return a load test as CSV."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    measured = test.places is not None
    writer.writerow(("pose", *JOINTS, *WRENCH, *(PLACE if measured else ())))
    columns = [np.degrees(test.joints), test.wrenches]
    if test.places is not None:
        columns.append(1e3 * test.places)
    for number, row in zip(test.poses, np.concatenate(columns, axis=1), strict=True):
        writer.writerow([int(number), *(f"{value + 0.0:.6f}" for value in row)])
    return text.getvalue()


def design(
    arm: Arm, elasticity: Elasticity, tool: NDArray[np.float64], count: int, force: float, seed: int
) -> LoadTest:
    """Choose poses and loads from which stiffness and backlash of all axes can be told.

    Of random poses, one after the other is taken that adds most to the determinant of the information (D-optimality,
    Fedorov, "Theory of Optimal Experiments", 1972). Each pose is loaded in six directions with half and whole force.

    Parameters
    ----------
    arm, elasticity : Arm, Elasticity
        The arm as far as it is known.
    tool : array of shape (4, 4)
        The tool's centre point in tool0; beside axis 6, or else axis 6 is never loaded.
    count : int
        Poses.
    force : float
        Greatest force [N].
    seed : int
        Of the random poses.

    Raises
    ------
    ValueError
        Where no pose loads all axes.
    """
    rng = np.random.default_rng(seed)
    candidates = _candidates(arm, tool, rng)
    directions = np.concatenate([scale * np.concatenate([np.eye(3), -np.eye(3)]) for scale in (0.5, 1.0)])
    wrenches = np.concatenate([force * directions, np.zeros((len(directions), 3))], axis=1)
    parts = []
    for joints in candidates:
        rows = np.tile(joints, (len(wrenches), 1))
        parts.append(information(arm, elasticity, LoadTest(np.zeros(len(rows), np.int64), rows, wrenches), tool))
    scale = 1.0 / np.sqrt(np.maximum(np.diag(sum(parts)), 1e-300))
    total = 1e-9 * np.eye(12)
    chosen: list[int] = []
    for _ in range(count):
        left = [number for number in range(len(parts)) if number not in chosen]
        gains = [np.linalg.slogdet(total + scale[:, None] * parts[number] * scale)[1] for number in left]
        best = left[int(np.argmax(gains))]
        chosen.append(best)
        total = total + scale[:, None] * parts[best] * scale
    if np.linalg.eigvalsh(total)[0] < MIN_INFORMATION:
        raise ValueError(
            "no poses load all axes in both directions; give a tool beside axis 6, more force or more poses"
        )
    joints = np.repeat(candidates[chosen], len(wrenches), axis=0)
    orders = [wrenches[rng.permutation(len(wrenches))] for _ in chosen]  # friction depends on the load before
    return LoadTest(np.repeat(np.arange(1, count + 1), len(wrenches)), joints, np.concatenate(orders))


def information(arm: Arm, elasticity: Elasticity, test: LoadTest, tool: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the information (12, 12) on compliances and half plays, without the noise's variance."""
    rows, _ = regressors(arm, elasticity, test, tool)
    return rows.T @ rows


def regressors(
    arm: Arm, elasticity: Elasticity, test: LoadTest, tool: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Return the derivatives of places by the compliances and half plays of the axes, without each pose's mean.

    Where a torque is near Coulomb friction or below, it is not known on which flank the transmission lies: such loads
    are left out.

    Returns
    -------
    rows : array of shape (3 m, 12)
        x, y and z of each load that is used.
    used : array of bool of shape (n,)
        Which loads are used.
    """
    points = (forward(arm, test.joints) @ tool)[:, :3, 3]
    full = jacobians(arm, test.joints, points)
    torques = np.einsum("nij,ni->nj", full, test.wrenches) + elasticity.gravity(arm, test.joints)
    used = (np.abs(torques) > FRICTION_MARGIN * elasticity.coulomb_friction).all(axis=1)
    linear = -full[:, :3]
    rows = np.concatenate([linear * torques[:, None, :], linear * np.sign(torques)[:, None, :]], axis=2)[used]
    return centred(rows, test.poses[used]).reshape(-1, 12), used


def centred(values: NDArray[np.float64], poses: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return values (n, ...) without the mean of their pose: the place of the unloaded tool is not known."""
    out = values.copy()
    for number in np.unique(poses):
        rows = poses == number
        out[rows] -= values[rows].mean(axis=0)
    return out


def _candidates(arm: Arm, tool: NDArray[np.float64], rng: np.random.Generator) -> NDArray[np.float64]:
    lower, upper = REACH_SHARE * arm.limits.T
    joints = rng.uniform(lower, upper, (20 * CANDIDATES, 6))
    points: NDArray[np.float64] = (forward(arm, joints) @ tool)[:, :3, 3]
    good = (points[:, 2] > FLOOR) & (np.hypot(points[:, 0], points[:, 1]) > 1.0)
    good &= singularities(arm, joints, 0.1, 0.1) == 0
    chosen: NDArray[np.float64] = joints[good][:CANDIDATES]
    return chosen
