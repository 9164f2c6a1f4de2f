"""Calibration of the tool centre point from flange poses in which the tool's tip touched the same point."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

_MIN_POSES = 3
_WORST_CONDITION = 1e6


class CalibrationError(ValueError):
    """Error of poses that do not determine the result; the message states the remedy."""


@dataclass(frozen=True)
class ToolCalibration:
    """Result of a tool calibration from four or more touches.

    Attributes
    ----------
    offset : (3,) array
        The tool centre point in the flange's frame [m].
    point : (3,) array
        The touched point in the base frame [m].
    residual_m : float
        Root mean square distance between the touches and the point. A small one is no proof of a good offset:
        poses of nearly the same orientation agree with each other on a wrong one.
    deviation : (3,) array
        Standard deviation of each component of the offset [m], from the residual and the geometry of the poses.
    condition : float
        Condition number of the equations: 2 to 10 with tilts of 30 to 60 degrees, large with small tilts.
    """

    offset: NDArray[np.float64]
    point: NDArray[np.float64]
    residual_m: float
    deviation: NDArray[np.float64]
    condition: float


def calibrate_tool(positions: ArrayLike, rotations: ArrayLike) -> ToolCalibration:
    """Compute the tool centre point by least squares of ``R_i t + p_i = c`` over all poses.

    Parameters
    ----------
    positions : (n, 3) array
        Positions of the flange in the base frame [m].
    rotations : (n, 3, 3) array
        Rotations of the flange, base from flange.

    Raises
    ------
    CalibrationError
        With fewer than three poses, or where their orientations differ too little.
    """
    p = np.asarray(positions, float)
    r = np.asarray(rotations, float)
    if p.ndim != 2 or p.shape[1:] != (3,) or r.shape != (len(p), 3, 3):
        raise CalibrationError(f"expected n positions and n 3x3 rotations, got shapes {p.shape} and {r.shape}")
    if len(p) < _MIN_POSES:
        raise CalibrationError(f"{len(p)} poses are too few: touch the point from at least {_MIN_POSES} directions")
    equations = np.concatenate([r, np.tile(-np.eye(3), (len(p), 1, 1))], axis=2).reshape(-1, 6)
    condition = float(np.linalg.cond(equations))
    if condition > _WORST_CONDITION:
        raise CalibrationError("the poses have nearly the same orientation: tilt the tool about two axes between them")
    solution = np.linalg.lstsq(equations, -p.reshape(-1), rcond=None)[0]
    errors = equations @ solution + p.reshape(-1)
    freedom = errors.size - solution.size
    variance = float(errors @ errors) / freedom if freedom else 0.0
    covariance = variance * np.linalg.inv(equations.T @ equations)
    return ToolCalibration(
        offset=solution[:3],
        point=solution[3:],
        residual_m=float(np.sqrt(np.mean(np.sum(errors.reshape(-1, 3) ** 2, axis=1)))),
        deviation=np.sqrt(np.diag(covariance)[:3]),
        condition=condition,
    )
