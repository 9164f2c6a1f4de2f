"""Predefined routines on the robot itself: positions from angles and back, units, speeds, kept paths."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from daidalos.industry.rapid.runtime.errors import RapidError
from daidalos.industry.rapid.runtime.positions import WOBJ0
from daidalos.industry.rapid.runtime.registry import routine

if TYPE_CHECKING:
    from daidalos.industry.rapid.runtime.task import Task

MAX_ROBOT_SPEED = 7000.0
"""Greatest speed of the tool [mm/s], that of v7000."""


@routine("CalcRobT")
def target_of_joints(
    task: Task, joint_target_: list[Any], tool_: list[Any], wobj_: list[Any] | None = None
) -> list[Any]:
    """Return the robtarget of angles."""
    return task.robot.target_of(joint_target_, tool_, wobj_ or WOBJ0)


@routine("CalcJointT")
def joints_of_target(
    task: Task, rob_target_: list[Any], tool_: list[Any], wobj_: list[Any] | None = None, errornumber_: Any = None,
    **rest: Any,
) -> list[Any]:  # fmt: skip
    """Return the angles of a robtarget.

    Raises
    ------
    RapidError
        ERR_ROBLIMIT, where it is out of reach and no variable takes the number of the error.
    """
    try:
        found = task.robot.joints_of(rob_target_, tool_, wobj_ or WOBJ0)
    except RapidError as error:
        if errornumber_ is None:
            raise
        errornumber_[0][errornumber_[1]] = error.number
        return task.robot.jointtarget()
    if errornumber_ is not None:
        errornumber_[0][errornumber_[1]] = 0.0
    return found


@routine("GetMotorTorque")
def motor_torque(task: Task, axisno_: float, mecunit_: Any = None) -> float:
    """Return the torque of an axis: 0, since the arm has no loads here."""
    return 0.0


@routine("MaxRobSpeed")
def greatest_speed(task: Task) -> float:
    """Return the greatest speed of the tool in mm/s."""
    return MAX_ROBOT_SPEED


@routine("StorePath")
def store_path(task: Task, keepsync_: Any = None) -> None:
    """Keep the rest of the path for RestoPath: the robot has to be stopped on it."""
    task.robot.store()


@routine("RestoPath")
def restore_path(task: Task) -> None:
    """Take the rest of the path up that StorePath has kept."""
    task.robot.restore()


@routine("FitCircle")
def fit_circle(
    task: Task,
    points_: list[list[float]],
    center_: list[float],
    radius_: Any,
    normal_: list[float],
    numpoints_: float | None = None,
    rms_: Any = None,
    maxerr_: Any = None,
    indexworst_: Any = None,
) -> None:
    """Fit a circle to points: the plane by least squares, then the circle in it.

    Raises
    ------
    RapidError
        ERR_ARGVALERR with fewer than three points, or points on a line.
    """
    points = np.array(points_[: int(numpoints_) if numpoints_ else None], dtype=float)
    middle = points.mean(axis=0)
    if len(points) < _CIRCLE_POINTS:
        raise RapidError("ERR_ARGVALERR", f"a circle needs three points, not {len(points)}")
    _, sizes, axes = np.linalg.svd(points - middle)
    if sizes[1] < 1e-6 * max(sizes[0], 1e-9):
        raise RapidError("ERR_ARGVALERR", "the points are on a line")
    flat = (points - middle) @ axes[:2].T
    solution = np.linalg.lstsq(np.column_stack([flat, np.ones(len(flat))]), (flat**2).sum(axis=1), rcond=None)[0]
    centre = solution[:2] / 2.0
    radius = float(np.sqrt(solution[2] + centre @ centre))
    off_plane = (points - middle) @ axes[2]
    errors = np.hypot(np.hypot(*(flat - centre).T) - radius, off_plane)
    center_[:] = (middle + centre @ axes[:2]).tolist()
    normal_[:] = axes[2].tolist()
    values = (radius, float(np.sqrt(np.mean(errors**2))), float(errors.max()), float(errors.argmax() + 1))
    for reference, value in zip((radius_, rms_, maxerr_, indexworst_), values, strict=True):
        if reference is not None:
            reference[0][reference[1]] = value


_CIRCLE_POINTS = 3
