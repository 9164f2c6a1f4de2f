"""Plan of a weld: the corrected path of a seam with its figures."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daidalos.common.errors import UserError
from daidalos.industry.welding.bsplines import PathSpline, fit_path
from daidalos.industry.welding.correction import Cell, Correction, correct, deviations, in_axes, pose_errors
from daidalos.industry.welding.joint_paths import condition_numbers
from daidalos.industry.welding.placement import Candidate, rotate_about_tool, try_places, try_rotations
from daidalos.industry.welding.process import ProcessModel
from daidalos.industry.welding.seam import TILT, Seam, resampled, tool_axes, tool_poses
from daidalos.industry.welding.seam_csv import WRENCH_COLUMNS

DEFAULT_POINTS = 100
DEFAULT_SPINDLE_SPEED = 800.0 / 60.0
"""[turns/s]"""
FEW_POINTS = 50
DIRECTIONS = ("ahead", "across", "along_tool")


@dataclass(frozen=True)
class Request:
    """What is to be planned.

    Attributes
    ----------
    speed : float
        Of the tool, where the seam has no feeds [m/s].
    wrench : array of shape (6,) or None
        That the tool exerts on the workpiece, in its axes with x ahead [N, Nm]; None where the seam has its own.
    process : ProcessModel or None
        That tells the wrench by the feed and the spindle speed, in place of `wrench`.
    spindle_speed : float
        For the process model, where the seam has none [turns/s].
    tilt : float
        Of the tool against the normal [rad].
    rotation : float or None
        About the tool's axis [rad]; None for the stiffest.
    points : int or None
        Points of the corrected path; None for those of the seam, or 100 where it has fewer than 50.
    places : bool
        Whether other places of the workpiece are tried.
    """

    speed: float
    wrench: NDArray[np.float64] | None
    process: ProcessModel | None = None
    spindle_speed: float = DEFAULT_SPINDLE_SPEED
    tilt: float = TILT
    rotation: float | None = 0.0
    points: int | None = None
    places: bool = False


@dataclass(frozen=True)
class Plan:
    """A planned weld.

    Attributes
    ----------
    cell : Cell
        The robot.
    seam : Seam
        The seam at the planned points.
    axes : array of shape (n, 3, 3)
        Of wrenches and deviations: ahead, across, along the tool.
    wrenches : array of shape (n, 6)
        In these axes [N, Nm].
    desired_spline : PathSpline
        Through the desired path.
    correction : Correction
        The corrected path.
    speeds : array of shape (n,)
        Of the tool [m/s].
    rotation : float
        About the tool's axis [rad].
    process : ProcessModel or None
        That told the wrenches.
    rotations, places : tuple of Candidate
        What was tried, the stiffest first.
    """

    cell: Cell
    seam: Seam
    axes: NDArray[np.float64]
    wrenches: NDArray[np.float64]
    desired_spline: PathSpline
    correction: Correction
    speeds: NDArray[np.float64]
    rotation: float
    process: ProcessModel | None
    rotations: tuple[Candidate, ...]
    places: tuple[Candidate, ...]

    @property
    def speed(self) -> float:
        """Return the least speed of the tool [m/s]."""
        return float(self.speeds.min())

    @property
    def before(self) -> NDArray[np.float64]:
        """Return the deviations (n, 3) without correction [m]."""
        return deviations(self.correction.desired, self.correction.before.poses, self.axes)

    @property
    def after(self) -> NDArray[np.float64]:
        """Return the deviations (n, 3) with correction [m]."""
        return deviations(self.correction.desired, self.correction.after.poses, self.axes)

    def turned(self, state: str) -> NDArray[np.float64]:
        """Return by how much the loaded tool is turned from the desired pose (n, 3), in its axes [rad].

        `state` is ``before`` or ``after``.
        """
        poses = getattr(self.correction, state).poses
        return -in_axes(self.axes, pose_errors(self.correction.desired, poses)[1])

    def as_json(self) -> dict[str, Any]:
        """Return the figures, lengths in millimetres and angles in degrees."""
        done = self.correction
        knots, wanted = done.spline.knots(), self.desired_spline.knots()
        condition = condition_numbers(self.cell.arm, done.motors, done.desired[:, :3, 3])
        return {
            "robot": self.cell.arm.name,
            "points": len(done.desired),
            "length_mm": _mm(done.distances[-1]),
            "speed_mm_per_min": round(60e3 * self.speed, 6),
            "process": None if self.process is None else self.process.as_json(),
            "wrench": {
                name: {"least": round(float(column.min()), 3), "greatest": round(float(column.max()), 3)}
                for name, column in zip(WRENCH_COLUMNS, self.wrenches.T, strict=True)
            },
            "rotation_deg": round(math.degrees(self.rotation), 3),
            "cfx": done.branch,
            "before": _figures(self.before, self.turned("before")),
            "after": _figures(self.after, self.turned("after")),
            "convergence": [
                {"distance_mm": 1e3 * one, "angle_deg": math.degrees(two)} for one, two in done.convergence
            ],
            "spline": {
                "degree": 4,
                "pieces": len(done.spline.pieces),
                "position_knots": knots[0],
                "orientation_knots": knots[1],
                "residual_mm": 1e3 * float(done.spline.residuals.max()),
                "residual_deg": math.degrees(float(done.spline.angle_residuals.max())),
                "desired_position_knots": wanted[0],
                "desired_residual_mm": 1e3 * float(self.desired_spline.residuals.max()),
            },
            "torques_nm": [
                {"axis": axis + 1, "least": round(float(column.min()), 1), "greatest": round(float(column.max()), 1)}
                for axis, column in enumerate(done.after.torques.T)
            ],
            "flank_changes": [int(one) for one in (np.diff(done.after.sides, axis=0) != 0.0).sum(axis=0)],
            "condition": {"least": round(float(condition.min()), 2), "greatest": round(float(condition.max()), 2)},
            "zones": self.zones(),
            "rotations": [_candidate(one, math.degrees, "deg") for one in self.rotations],
            "places": [_candidate(one, lambda value: 1e3 * value, "mm") for one in self.places],
        }

    def zones(self) -> list[dict[str, Any]]:
        """Return the mean deviations of each zone before and after the correction [mm]."""
        names = np.array(self.seam.zones)
        return [
            {"zone": str(name)}
            | {
                f"{state}_{direction}_mm": _mm(values[names == name, index].mean())
                for state, values in (("before", self.before), ("after", self.after))
                for index, direction in enumerate(DIRECTIONS)
            }
            for name in dict.fromkeys(self.seam.zones)
        ]


def plan(cell: Cell, seam: Seam, request: Request, title: str = "path") -> Plan:
    """Plan the weld of a seam.

    Raises
    ------
    UserError
        Where there is no wrench, or the path cannot be followed or corrected.
    """
    count = request.points
    if count is None:
        count = len(seam.positions) if len(seam.positions) >= FEW_POINTS else DEFAULT_POINTS
    dense = resampled(seam, count)
    speeds = np.full(count, request.speed) if dense.feeds is None else dense.feeds
    wrenches = _wrenches(dense, request, speeds, title)
    poses = tool_poses(dense, request.tilt)
    axes = tool_axes(dense, poses)
    rotations: tuple[Candidate, ...] = ()
    rotation = request.rotation
    if rotation is None:
        rotations = tuple(try_rotations(cell, poses, axes, wrenches))
        rotation = rotations[0].value[0]
    poses = rotate_about_tool(poses, rotation)
    places = tuple(try_places(cell, poses, axes, wrenches)) if request.places else ()
    wanted = fit_path(dense.distances, poses)
    turned = np.swapaxes(wanted.poses[:, :3, :3], 1, 2) @ axes
    in_tool = np.concatenate(
        [np.einsum("nij,nj->ni", turned, wrenches[:, part]) for part in (slice(3), slice(3, 6))], 1
    )
    done = correct(cell, wanted.poses, in_tool, speeds, title)
    return Plan(cell, dense, axes, wrenches, wanted, done, speeds, rotation, request.process, rotations, places)


def _wrenches(seam: Seam, request: Request, speeds: NDArray[np.float64], title: str) -> NDArray[np.float64]:
    """Return the wrenches (n, 6) of a request at the points of a seam with speeds of the tool (n,) [m/s]."""
    if request.wrench is not None:
        return np.tile(request.wrench, (len(seam.positions), 1))
    if request.process is not None:
        turns = np.full_like(speeds, request.spindle_speed) if seam.spindle_speeds is None else seam.spindle_speeds
        return request.process.wrenches(speeds, turns)
    if seam.wrenches is None:
        raise UserError(
            f"{title}: has no columns fx, fy, fz, mx, my, mz; give --wrench FX FY FZ MX MY MZ, or --process"
        )
    return seam.wrenches


def _figures(moved: NDArray[np.float64], turned: NDArray[np.float64]) -> dict[str, Any]:
    """Return root mean squares and extremes of deviations [m] and rotations [rad]."""
    out: dict[str, Any] = {}
    for index, direction in enumerate(DIRECTIONS):
        column = moved[:, index]
        out[f"{direction}_rms_mm"] = _mm(np.sqrt((column**2).mean()))
        out[f"{direction}_range_mm"] = [_mm(column.min()), _mm(column.max())]
    angles = np.degrees(np.sqrt((turned**2).mean(axis=0)))
    return out | {"rotation_rms_deg": [round(float(value), 5) for value in angles]}


def _mm(value: float) -> float:
    return round(1e3 * float(value), 5) + 0.0


def _candidate(one: Candidate, convert: Any, unit: str) -> dict[str, Any]:
    return {
        f"value_{unit}": [round(convert(value), 3) for value in one.value],
        "deflection_mm": _mm(one.deflection) if math.isfinite(one.deflection) else None,
    }
