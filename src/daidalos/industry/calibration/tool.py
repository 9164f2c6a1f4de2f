"""Calibration of the tool centre point from flange poses in which the tool's tip touched the same point."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

_MIN_POSES = 3
_WORST_CONDITION = 1e6
LARGE_CONDITION = 20.0
"""Condition number above which the geometry is bad: tilts of some 6 degrees."""

LARGE_DEVIATION = 1e-3
"""Deviation above which a result is doubtful [m]."""


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
    covariance : (3, 3) array
        Covariance of the offset [m^2], whose diagonal is the square of `deviation`.
    """

    offset: NDArray[np.float64]
    point: NDArray[np.float64]
    residual_m: float
    deviation: NDArray[np.float64]
    condition: float
    covariance: NDArray[np.float64]

    def warnings(self) -> list[str]:
        """Return what makes the offset doubtful: small tilts between the poses, large errors, no redundancy."""
        found = []
        if self.condition > LARGE_CONDITION:
            found.append(
                f"bad geometry: condition {self.condition:.0f}, more than {LARGE_CONDITION:.0f}; tilt the tool farther "
                "between the poses, about two axes"
            )
        if self.deviation.max() > LARGE_DEVIATION:
            found.append(f"the offset is uncertain by {1e3 * self.deviation.max():.2f} mm (1 sigma); touch more poses")
        if self.residual_m > LARGE_DEVIATION:
            found.append(
                f"the touches are {1e3 * self.residual_m:.2f} mm apart: one of them is wrong, or the tip moved"
            )
        return found


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
        covariance=covariance[:3, :3],
    )


def tool_rotation(
    calibration: ToolCalibration,
    z_pose: tuple[ArrayLike, ArrayLike],
    x_pose: tuple[ArrayLike, ArrayLike] | None = None,
) -> NDArray[np.float64]:
    """Return the rotation (3, 3) of the tool, flange from tool, from poses with the touched point on its axes.

    Without a pose for x, the tool's x axis is as near as it can be to that of the flange.

    Parameters
    ----------
    calibration
        The offset, and the touched point.
    z_pose, x_pose
        Position (3,) [m] and rotation (3, 3) of the flange with the touched point on the positive z or x axis.

    Raises
    ------
    CalibrationError
        Where the point is less than 10 mm from the tool's tip, or both axes are nearly parallel.
    """
    z = _direction(calibration, z_pose, "z")
    x = _direction(calibration, x_pose, "x") if x_pose is not None else np.eye(3)[0]
    if x_pose is None and abs(z[0]) > _PARALLEL:
        x = np.eye(3)[1]
    if abs(float(x @ z)) > _PARALLEL:
        raise CalibrationError("the points on z and x lie in nearly the same direction from the tip")
    x = x - (x @ z) * z
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])


_PARALLEL = 0.94
_SHORTEST_AXIS = 0.01


def _direction(calibration: ToolCalibration, pose: tuple[ArrayLike, ArrayLike], axis: str) -> NDArray[np.float64]:
    position, rotation = (np.asarray(one, float) for one in pose)
    way = rotation.T @ (calibration.point - position) - calibration.offset
    length = float(np.linalg.norm(way))
    if length < _SHORTEST_AXIS:
        raise CalibrationError(f"the point on {axis} is {1e3 * length:.1f} mm from the tip; move at least 10 mm away")
    return np.asarray(way / length)
