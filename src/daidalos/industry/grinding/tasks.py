"""Tasks of the demonstration: a force test, an even layer on a plate, and excess material on a clamp."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.errors import UserError
from daidalos.common.extensions import find
from daidalos.common.parameters import Parameters, parameters_from
from daidalos.industry.grinding.cell import Cell, Fault
from daidalos.industry.grinding.extensions import FORCE_CONTROLLERS
from daidalos.industry.grinding.force_control import ForceController
from daidalos.industry.grinding.grinding import RAMP_RATE, Grinding
from daidalos.industry.grinding.height_field import Deviation, Workpiece, deviation, scanned
from daidalos.industry.grinding.passes import STEP, Line, even_passes, excess_passes, footprint, tools_along
from daidalos.industry.grinding.reach import joints_along
from daidalos.industry.grinding.records import Record, force_figures, recorded
from daidalos.industry.grinding.settings import PERIOD, CellParameters
from daidalos.industry.grinding.workpieces import plate

MAX_PASSES = 15
WITHIN = 0.99
"""Share of the cells that has to be within the tolerance at the end."""
STEPS = (10.0, 30.0, 50.0, 30.0)
"""Wanted forces of the force test [N]."""
STEP_TIME = 2.5
TEST_FEED = 0.02


@dataclass(frozen=True)
class Pass:
    """One pass over a workpiece.

    Attributes
    ----------
    lines : tuple of Line
    record : Record
    before, after : Deviation
        As scanned.
    predicted, removed : float
        Volume [m^3], by the plan and by the scans.
    preston : float
        Coefficient that the plan was made with [1/Pa].
    problem : str
        Why it was stopped; empty where it was not.
    """

    lines: tuple[Line, ...]
    record: Record
    before: Deviation
    after: Deviation
    predicted: float
    removed: float
    preston: float
    problem: str


@dataclass(frozen=True)
class Job:
    """Passes over a workpiece until it is within its tolerance.

    Attributes
    ----------
    title : str
    begin, end : Workpiece
        As scanned before and after.
    passes : tuple of Pass
    tolerance : float
        [m]
    wear : float
        Share of the disc's layer that is worn off at the end.
    problem : str
        Why it ended before it was within its tolerance; empty where it is.
    """

    title: str
    begin: Workpiece
    end: Workpiece
    passes: tuple[Pass, ...]
    tolerance: float
    wear: float
    problem: str

    @property
    def depth_removed(self) -> NDArray[np.float64]:
        """Return the removed depth (rows, columns) [m]."""
        return self.begin.surface - self.end.surface


def make_controller(name: str, settings: dict[str, object], parameters: CellParameters) -> ForceController:
    """Return the force controller of a name, with settings by name.

    Raises
    ------
    UserError
        Where there is none, or it has no such parameter.
    """
    kind = find(FORCE_CONTROLLERS, name)
    own: Parameters = parameters_from(kind.settings_class, settings)
    return kind(own, parameters.actuator, PERIOD)


def check_force(force: float, parameters: CellParameters) -> None:
    """Raise a UserError where a force [N] cannot be controlled."""
    low, high = parameters.safety.touch_force, parameters.safety.max_force
    if not low <= force <= 0.8 * high:
        raise UserError(f"the force is {force:g} N, but must be {low:g} to {0.8 * high:g} N")


def force_test(
    parameters: CellParameters,
    controller: ForceController,
    seed: int = 0,
    faults: Sequence[Fault] = (),
    is_supervised: bool = True,
    resolution: float = 0.25e-3,
) -> tuple[Record, Grinding]:
    """Grind along a plate with steps of the wanted force, and return the record and the run."""
    piece = plate(0.3, depth=0.0, roughness=1e-6, seed=seed, resolution=resolution)
    offset = footprint(parameters, piece.resolution, STEPS[1], parameters.disc.preston).offset
    cell = Cell(parameters, piece, offset, controller.mode, seed, parameters.disc.wear)
    cell.faults = tuple(faults)
    line = _stepped_line()
    run = Grinding(
        cell, controller, [line], [tools_along(line, piece, piece.surface, parameters, offset)],
        ramp=math.inf, is_supervised=is_supervised,
    )  # fmt: skip
    return recorded(run), run


def _stepped_line() -> Line:
    length = TEST_FEED * STEP_TIME
    ends = np.arange(len(STEPS) + 1) * length
    along = np.sort(np.concatenate([np.arange(0.0, ends[-1], STEP), ends[1:], ends[1:-1] + 1e-6]))
    along = along[np.concatenate([[True], np.diff(along) > 5e-7])]
    level = np.clip(np.searchsorted(ends[1:], along, side="left"), 0, len(STEPS) - 1)
    points = np.stack([along - 0.5 * ends[-1], np.zeros_like(along)], axis=1)
    return Line(points, np.full_like(along, TEST_FEED), np.array(STEPS)[level])


class JobRun:
    """Job that is done pass by pass: scan, plan, grind, and scan again.

    `joints` has the arm's angles (n, 6) at the points of each line of the last pass [rad].

    Parameters
    ----------
    title : str
    piece : Workpiece
        The true one.
    parameters : CellParameters
    make : callable
        Returns a new force controller for each pass.
    plan : callable
        Returns the lines of the next pass for a scan and a coefficient of Preston [1/Pa]; none where it is done.
    tolerance : float
        [m]
    seed : int
    faults : sequence of Fault
    """

    def __init__(
        self,
        title: str,
        piece: Workpiece,
        parameters: CellParameters,
        make: Callable[[], ForceController],
        plan: Callable[[Workpiece, float], list[Line]],
        tolerance: float,
        seed: int = 0,
        faults: Sequence[Fault] = (),
        max_passes: int = MAX_PASSES,
    ) -> None:
        self.title, self.tolerance, self.parameters = title, tolerance, parameters
        self.piece = piece
        self.passes: list[Pass] = []
        self.problem = ""
        self._make, self._plan, self._seed = make, plan, seed
        self._faults, self._max_passes = faults, max_passes
        self._rng = np.random.default_rng(seed)
        self._preston = parameters.disc.preston
        self._wear = parameters.disc.wear
        self.scan = self.first_scan = scanned(piece, parameters.sensor.scan_noise, self._rng)
        self.joints: list[NDArray[np.float64]] = []
        self.time = 0.0

    def next_pass(self, robot: str) -> tuple[list[Line], Grinding] | None:
        """Return lines and run of the next pass; None where the job has ended.

        Raises
        ------
        UserError
            Where the robot cannot follow them.
        """
        if self.problem:
            return None
        lines = self._plan(self.scan, self._preston)
        if not lines:
            within = deviation(self.scan, self.tolerance).within
            if within < WITHIN:
                self.problem = f"only {100.0 * within:.1f} % of the region are within {1e6 * self.tolerance:.0f} um"
            return None
        if len(self.passes) == self._max_passes:
            self.problem = f"not within {1e6 * self.tolerance:.0f} um after {self._max_passes} passes"
            return None
        force = float(lines[0].forces.max())
        offset = footprint(self.parameters, self.piece.resolution, force, self.parameters.disc.preston).offset
        tools = [tools_along(line, self.scan, self.scan.surface, self.parameters, offset) for line in lines]
        self.joints = joints_along(robot, tools, self.piece)
        controller = self._make()
        cell = Cell(self.parameters, self.piece, offset, controller.mode, self._seed + len(self.passes), self._wear)
        cell.faults = tuple(Fault(one.kind, one.time - self.time) for one in self._faults)
        return lines, Grinding(cell, controller, lines, tools, RAMP_RATE)

    def finish_pass(self, lines: list[Line], run: Grinding, record: Record) -> Pass:
        """Scan what a run has left, learn how fast the disc grinds, and return the pass."""
        self._wear = run.cell.wear
        self.time += run.cell.time
        self.piece = self.piece.with_surface(run.cell.surface)
        before = self.scan
        self.scan = scanned(self.piece, self.parameters.sensor.scan_noise, self._rng)
        predicted = planned_volume(lines, self.parameters, before.resolution, self._preston)
        removed = float((before.surface - self.scan.surface).sum()) * before.resolution**2
        done = Pass(
            tuple(lines), record.thinned(), deviation(before, self.tolerance), deviation(self.scan, self.tolerance),
            predicted, removed, self._preston, run.problem,
        )  # fmt: skip
        self.passes.append(done)
        if run.problem:
            self.problem = f"pass {len(self.passes)}: {run.problem}"
        elif predicted > 0.0:
            self._preston *= min(max(removed / predicted, 0.5), 2.0)
        return done

    def result(self) -> Job:
        """Return the job as it is now."""
        return Job(self.title, self.first_scan, self.scan, tuple(self.passes), self.tolerance, self._wear, self.problem)

    def run(self, robot: str, on_pass: Callable[[Pass], None] | None = None) -> Job:
        """Do the whole job with an arm of a name."""
        while (following := self.next_pass(robot)) is not None:
            lines, run = following
            done = self.finish_pass(lines, run, recorded(run))
            if on_pass is not None:
                on_pass(done)
        return self.result()


def planned_volume(lines: Sequence[Line], parameters: CellParameters, resolution: float, preston: float) -> float:
    """Return the volume that lines remove by the plan [m^3]."""
    rates = {
        force: footprint(parameters, resolution, force, preston).volume_rate
        for force in {float(line.forces[0]) for line in lines}
    }
    return sum(rates[float(line.forces[0])] * line.duration for line in lines)


def plate_job(
    piece: Workpiece,
    parameters: CellParameters,
    make: Callable[[], ForceController],
    force: float,
    depth: float,
    spacing: float,
    seed: int = 0,
    faults: Sequence[Fault] = (),
) -> JobRun:
    """Return the job of removing an even layer in one pass; its tolerance is 20 percent of the layer."""

    def plan(scan: Workpiece, preston: float) -> list[Line]:
        return [] if scan is not job.first_scan else even_passes(scan, parameters, depth, force, spacing, preston)

    check_force(force, parameters)
    job = JobRun("plate", piece, parameters, make, plan, 0.2 * depth, seed, faults)
    return job


def clamp_job(
    piece: Workpiece,
    parameters: CellParameters,
    make: Callable[[], ForceController],
    force: float,
    tolerance: float,
    seed: int = 0,
    faults: Sequence[Fault] = (),
    max_passes: int = MAX_PASSES,
) -> JobRun:
    """Return the job of removing excess material down to the target, in passes until it is within the tolerance."""

    def plan(scan: Workpiece, preston: float) -> list[Line]:
        return excess_passes(scan, parameters, tolerance, force, preston)

    check_force(force, parameters)
    return JobRun("clamp", piece, parameters, make, plan, tolerance, seed, faults, max_passes)


def job_figures(job: Job) -> dict[str, object]:
    """Return the figures of a job."""
    passes = []
    for number, one in enumerate(job.passes, 1):
        passes.append(
            {
                "pass": number,
                "lines": len(one.lines),
                "time_s": round(float(one.record.time[-1]), 2) if len(one.record.time) else 0.0,
                "predicted_mm3": round(1e9 * one.predicted, 1),
                "removed_mm3": round(1e9 * one.removed, 1),
                "preston_per_pa": float(f"{one.preston:.4g}"),
                "force": force_figures(one.record).as_json(),
                "deviation": one.after.as_json(),
                "problem": one.problem,
            }
        )
    before = deviation(job.begin, job.tolerance).as_json()
    return {
        "task": job.title,
        "tolerance_um": round(1e6 * job.tolerance, 2),
        "before": before,
        "after": deviation(job.end, job.tolerance).as_json(),
        "passes": passes,
        "wear_percent": round(100.0 * job.wear, 3),
        "problem": job.problem,
    }
