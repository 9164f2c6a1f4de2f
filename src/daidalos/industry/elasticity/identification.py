"""Identification of stiffness and backlash from load tests, and of friction from runs at constant speed."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daidalos.common.documents import DocumentError
from daidalos.industry.columns import read_columns
from daidalos.industry.elasticity.deflection import Options, load
from daidalos.industry.elasticity.elasticity import Elasticity
from daidalos.industry.elasticity.load_tests import LoadTest, centred, regressors
from daidalos.industry.motion.kinematics import forward
from daidalos.industry.robots.arm import Arm

OUTLIER = 4.0
"""Residual, in standard deviations, beyond which a measurement is left out."""
GAUSS_NEWTON_STEPS = 4
MIN_CONDITION_SHARE = 1e-9
FRICTION_COLUMNS = ("axis", "speed_deg_s", "torque_nm")


@dataclass(frozen=True)
class Identification:
    """Stiffness and backlash with their standard deviations.

    Attributes
    ----------
    stiffness, stiffness_deviation : array of shape (6,)
        [Nm/rad]
    backlash, backlash_deviation : array of shape (6,)
        Whole play [rad].
    noise : float
        Standard deviation of the residuals [m].
    condition : float
        Condition number of the regressors, their columns scaled to the same length.
    used, given : int
        Loads that were used, and all.
    """

    stiffness: NDArray[np.float64]
    stiffness_deviation: NDArray[np.float64]
    backlash: NDArray[np.float64]
    backlash_deviation: NDArray[np.float64]
    noise: float
    condition: float
    used: int
    given: int

    def as_json(self) -> dict[str, Any]:
        """Return the figures; backlash in minutes of arc, confidence of 95 %."""
        arcmin = np.degrees(1.0) * 60.0
        return {
            "axes": [
                {
                    "axis": axis + 1,
                    "stiffness_nm_per_rad": float(f"{self.stiffness[axis]:.6g}"),
                    "stiffness_confidence": float(f"{1.96 * self.stiffness_deviation[axis]:.3g}"),
                    "backlash_arcmin": round(arcmin * float(self.backlash[axis]), 4),
                    "backlash_confidence": round(1.96 * arcmin * float(self.backlash_deviation[axis]), 4),
                }
                for axis in range(6)
            ],
            "noise_mm": round(1e3 * self.noise, 5),
            "condition": round(self.condition, 1),
            "used_loads": self.used,
            "given_loads": self.given,
        }


def identify(arm: Arm, elasticity: Elasticity, test: LoadTest, tool: NDArray[np.float64]) -> Identification:
    """Estimate stiffness and backlash of all axes by least squares.

    The place of the loaded tool is x0 - J (c tau + a sign tau), with a free x0 for each pose and torques that hold the
    load and the weight of the links. It is linear in the compliances c and the half plays a; what the arm's change of
    pose under load adds is found by repetition (Gauss-Newton).

    Parameters
    ----------
    arm, elasticity : Arm, Elasticity
        The arm; of the elasticity, masses, balancing and friction are used.
    test : LoadTest
        With measured places.
    tool : array of shape (4, 4)
        The tool's centre point in tool0.

    Raises
    ------
    ValueError
        Where the loads do not tell all twelve parameters.
    """
    assert test.places is not None
    rows, used = regressors(arm, elasticity, test, tool)
    values = centred(test.places[used], test.poses[used]).ravel()
    free = 3 * len(np.unique(test.poses[used])) + 12
    if len(values) <= free:
        raise ValueError(f"{int(used.sum())} usable loads are too few; at least {free // 3 + 1} are needed")
    lengths = np.linalg.norm(rows, axis=0)
    blind = lengths < MIN_CONDITION_SHARE * lengths.max()
    scaled = rows / np.where(lengths > 0.0, lengths, 1.0)
    condition = float(np.linalg.cond(scaled))
    if condition > 1e6 or blind.any():
        weakest = np.abs(np.linalg.svd(scaled)[2][-1])
        axis = int((np.argmax(blind) if blind.any() else np.argmax(weakest)) % 6) + 1
        raise ValueError(f"the loads do not tell stiffness and backlash of axis {axis}; load it in both directions")
    found = np.zeros(12)
    predicted = np.zeros_like(values)
    for _ in range(GAUSS_NEWTON_STEPS):
        step, keep, noise = _solve(scaled, values - predicted, free)
        found = found + step / lengths
        if (found[:6] <= 0.0).any():
            axis = int(np.argmin(found[:6])) + 1
            raise ValueError(f"the loads make axis {axis} give way against its torque; check signs, frames and units")
        predicted = _predict(arm, elasticity, test, used, tool, found)
    covariance = noise**2 * np.linalg.inv(scaled[keep].T @ scaled[keep])
    deviations = np.sqrt(np.diag(covariance)) / lengths
    compliance = found[:6]
    return Identification(
        1.0 / compliance,
        deviations[:6] / compliance**2,
        2.0 * np.maximum(found[6:], 0.0),
        2.0 * deviations[6:],
        noise,
        condition,
        int(used.sum()),
        len(used),
    )


def _solve(
    rows: NDArray[np.float64], values: NDArray[np.float64], free: int
) -> tuple[NDArray[np.float64], NDArray[np.bool_], float]:
    """Return the least squares solution, which values it uses, and the standard deviation of its residuals [m]."""
    keep: NDArray[np.bool_] = np.ones(len(values), dtype=np.bool_)
    for _ in range(5):
        solved, *_ = np.linalg.lstsq(rows[keep], values[keep], rcond=None)
        residuals = values - rows @ solved
        noise = float(np.sqrt((residuals[keep] ** 2).sum() / max(keep.sum() - free, 1)))
        inside = np.abs(residuals) <= OUTLIER * max(noise, 1e-12)
        if (inside == keep).all():
            break
        keep = inside
    return np.asarray(solved, dtype=np.float64), keep, noise


def _predict(
    arm: Arm,
    elasticity: Elasticity,
    test: LoadTest,
    used: NDArray[np.bool_],
    tool: NDArray[np.float64],
    found: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Return the places of the loaded tool without each pose's mean, for compliances and half plays (12,)."""
    joints, wrenches = test.joints[used], test.wrenches[used]
    guess = replace(
        elasticity,
        stiffness=1.0 / found[:6],
        backlash=2.0 * np.maximum(found[6:], 0.0),
        coulomb_friction=np.zeros(6),  # each flank by the sign of its own torque, not by the load before
    )
    poses = forward(arm, joints) @ tool
    for _ in range(2):
        turn = poses[:, :3, :3]
        in_tool = np.concatenate(
            [np.einsum("nji,nj->ni", turn, wrenches[:, part]) for part in (slice(3), slice(3, 6))], 1
        )
        poses = load(arm, guess, joints, tool, in_tool, np.zeros_like(joints), Options(gravity=True)).poses
    return centred(poses[:, :3, 3], test.poses[used]).ravel()


@dataclass(frozen=True)
class Friction:
    """Friction of one axis with standard deviations: Coulomb, breakaway [Nm], Stribeck speed [rad/s], viscous."""

    values: NDArray[np.float64]
    deviations: NDArray[np.float64]


def read_friction_runs(path: Path) -> dict[int, NDArray[np.float64]]:
    """Return speeds [rad/s] and torques [Nm] of runs at constant speed (n, 2) by axis.

    The columns are ``axis`` (1 to 6), ``speed_deg_s`` and ``torque_nm``, without the torque of gravity.

    Raises
    ------
    DocumentError
        Where it is no such file.
    """
    columns, lines, _ = read_columns(path, FRICTION_COLUMNS)
    for name in FRICTION_COLUMNS:
        if name not in columns:
            raise DocumentError(f"has no column '{name}'", str(path), 1)
    wrong = ~np.isin(columns["axis"], np.arange(1, 7))
    if wrong.any():
        raise DocumentError("'axis' must be 1 to 6", str(path), lines[int(np.argmax(wrong))])
    runs = np.column_stack([np.radians(columns["speed_deg_s"]), columns["torque_nm"]])
    return {int(axis): runs[columns["axis"] == axis] for axis in np.unique(columns["axis"])}


def identify_friction(runs: NDArray[np.float64]) -> Friction:
    """Fit Stribeck's curve to speeds [rad/s] and torques [Nm] (n, 2) of one axis in both directions.

    Raises
    ------
    ValueError
        Where there are fewer than eight runs, or only in one direction.
    """
    from scipy.optimize import least_squares

    speeds, torques = runs[:, 0], runs[:, 1]
    if len(runs) < 8 or not ((speeds > 0).any() and (speeds < 0).any()):
        raise ValueError("at least eight runs in both directions are needed")
    fast = np.abs(speeds)
    top, slowest = float(np.abs(torques).max()), float(fast[fast > 0.0].min())

    def errors(x: NDArray[np.float64]) -> NDArray[np.float64]:
        curve = x[0] + x[1] * np.exp(-((speeds / x[2]) ** 2))
        return np.sign(speeds) * curve + x[3] * speeds - torques  # type: ignore[no-any-return]

    start = [0.7 * top, 0.3 * top, float(np.median(fast)) / 3.0, 0.3 * top / float(fast.max())]
    bounds = ([0.0, 0.0, 0.3 * slowest, 0.0], [2.0 * top, 2.0 * top, float(fast.max()), np.inf])
    solved = least_squares(errors, np.clip(start, *bounds), bounds=bounds, x_scale=np.maximum(start, 1e-9))
    variance = float((solved.fun**2).sum()) / max(len(runs) - 4, 1)
    deviations = np.sqrt(variance * np.diag(np.linalg.pinv(solved.jac.T @ solved.jac)))
    coulomb, excess, stribeck, viscous = solved.x
    return Friction(
        np.array([coulomb, coulomb + excess, stribeck, viscous]),
        np.array([deviations[0], float(np.hypot(deviations[0], deviations[1])), deviations[2], deviations[3]]),
    )
