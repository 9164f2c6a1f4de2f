"""Guided calibration: which point is next, where the head aims, what each key does."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from daidalos.common.pose3 import Vector
from daidalos.industry.lighting.calibration import Calibration, CalibrationError, Observation, calibrate, propose
from daidalos.industry.lighting.kinematics import Angles, Geometry, Limits

STEPS = tuple(math.radians(one) for one in (5.0, 1.0, 0.2, 0.05, 0.01))
COLUMNS = 9
"""Points along x at which the expected error is computed."""
_ROWS = 7
_MIN_OBSERVATIONS = 4
_KEYS = {"left": (-1, 0), "right": (1, 0), "up": (0, 1), "down": (0, -1)}


@dataclass(frozen=True)
class Task:
    """Point to aim at, and in which of both flips."""

    point: Vector
    is_flipped: bool


class GuidedCalibration:
    """Session of a calibration without its terminal: tasks in turn, keys in, angles out.

    `result` is the best there is, None at first; `problem` says why there is none.

    Parameters
    ----------
    points : sequence of (x, y, z)
        Known points [m]; each is aimed at in both flips.
    start : Geometry
        About where the head is.
    limits : Limits
        Ranges of the axes; a flip out of range is left out.
    observations : sequence of Observation
        What an earlier session confirmed; it resumes after them.
    """

    def __init__(
        self, points: Sequence[Vector], start: Geometry, limits: Limits, observations: Sequence[Observation] = ()
    ) -> None:
        self._start, self._limits = start, limits
        self._tasks = [Task(point, flipped) for flipped in (False, True) for point in points]
        self.observations = list(observations)
        while len(self._tasks) < len(self.observations):  # an earlier session took proposed points as well
            self._tasks.append(Task(self.observations[len(self._tasks)].point, False))
        self._step = 1
        self.result: Calibration | None = None
        self.problem = ""
        self._solve()
        self.angles = self._predicted()

    @property
    def task(self) -> Task | None:
        """What is aimed at now; None when all is done."""
        return self._tasks[len(self.observations)] if len(self.observations) < len(self._tasks) else None

    @property
    def progress(self) -> tuple[int, int]:
        """Numbers of confirmed and of all directions."""
        return len(self.observations), len(self._tasks)

    @property
    def step(self) -> float:
        """Angle of one key press [rad]."""
        return STEPS[self._step]

    @property
    def geometry(self) -> Geometry:
        """Best knowledge of the head so far."""
        return self.result.geometry if self.result is not None else self._start

    def press(self, key: str) -> bool:
        """Do what a key asks; return whether it means anything here.

        Arrow keys turn by the step, ``+`` and ``-`` change the step, Enter confirms, ``u`` takes the last confirmation
        back.
        """
        if key in _KEYS and self.task is not None:
            pan, tilt = _KEYS[key]
            self.turn_by(pan * self.step, tilt * self.step)
        elif key in ("+", "-"):
            self._step = min(max(self._step + (1 if key == "-" else -1), 0), len(STEPS) - 1)
        elif key in ("\r", "\n") and self.task is not None:
            self.observations.append(Observation(self.task.point, self.angles))
            self._next()
        elif key == "u" and self.observations:
            last = self.observations.pop()
            self._solve()
            self.angles = last.angles
        else:
            return False
        return True

    def turn_by(self, pan: float, tilt: float) -> None:
        """Turn by angles [rad], within the ranges of the axes."""
        limits = self._limits
        self.angles = Angles(
            min(max(self.angles.pan + pan, limits.pan[0]), limits.pan[1]),
            min(max(self.angles.tilt + tilt, limits.tilt[0]), limits.tilt[1]),
        )

    def add_proposal(self, targets: Sequence[Vector]) -> Task:
        """Add the direction that helps most over some targets, of both flips at each of them.

        Raises
        ------
        CalibrationError
            While there is no result yet.
        """
        if self.result is None:
            raise CalibrationError("there is no result yet to improve")
        found = [
            (Task(target, flipped), Observation(target, angles))
            for target in targets
            for flipped, angles in zip((False, True), self._both(target), strict=True)
            if angles is not None
        ]
        best = propose(self.result, targets, [one for _, one in found])
        task = next(task for task, one in found if one is best)
        self._tasks.append(task)
        self.angles = self._predicted()
        return task

    def _next(self) -> None:
        self._solve()
        while self.task is not None and self._both(self.task.point)[self.task.is_flipped] is None:
            del self._tasks[len(self.observations)]
        self.angles = self._predicted()

    def _solve(self) -> None:
        """Compute the result of what there is; `problem` says why there is none."""
        self.result, self.problem = None, "" if self.task is not None else "too few directions are confirmed"
        if len(self.observations) >= _MIN_OBSERVATIONS:
            try:
                self.result, self.problem = calibrate(self.observations, self._start), ""
            except CalibrationError as error:
                self.problem = str(error)

    def _predicted(self) -> Angles:
        """Return where the head should aim at the task by what is known."""
        if self.task is None:
            return self.observations[-1].angles
        return self._both(self.task.point)[self.task.is_flipped] or Angles(0.0, 0.0)

    def _both(self, point: Vector) -> tuple[Angles | None, Angles | None]:
        """Return the angles of both flips: the first is the one with the positive tilt; None where out of range."""
        first, second = (one if self._limits.allow(one) else None for one in self.geometry.solutions(point))
        return first, second


def corners(table: Sequence[float]) -> list[Vector]:
    """Return the corners of a table from two of them and its height [m]: x0, y0, x1, y1, z.

    Raises
    ------
    CalibrationError
        When they enclose nothing.
    """
    x0, y0, x1, y1, z = table
    if not all(math.isfinite(one) for one in table) or x0 == x1 or y0 == y1:
        raise CalibrationError("a table needs two different corners and a height")
    return [(x0, y0, z), (x0, y1, z), (x1, y0, z), (x1, y1, z)]


def table_targets(points: Sequence[Vector]) -> list[Vector]:
    """Return points of the rectangle that encloses the known ones, at their mean height, row by row [m]."""
    xs, ys, zs = zip(*points, strict=True)
    height = sum(zs) / len(zs)
    return [
        (float(x), float(y), height)
        for y in np.linspace(min(ys), max(ys), _ROWS)
        for x in np.linspace(min(xs), max(xs), COLUMNS)
    ]


def session_file(output: Path) -> Path:
    """Return the file that keeps what is confirmed until the result is written."""
    return output.with_name(f"{output.name}.session")
