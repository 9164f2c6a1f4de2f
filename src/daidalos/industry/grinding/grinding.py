"""Grinding along lines: touching down, force control, lifting off, and what happens when something breaks."""

from __future__ import annotations

import bisect
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

from daidalos.industry.grinding.cell import Cell, Tool
from daidalos.industry.grinding.force_control import Command, ForceController, Measurement, ValveMode
from daidalos.industry.grinding.passes import Line
from daidalos.industry.grinding.settings import PERIOD
from daidalos.industry.grinding.supervision import Situation, Supervisor

LIFT_SPEED = 0.15
"""Speed at which the arm lifts the tool off [m/s]."""
LIFT_FORCE = 12.0
"""Force with which the piston is drawn back [N]."""
TRAVEL_SPEED = 0.25
"""Speed of the arm between two lines [m/s]."""
RAMP_RATE = 150.0
"""Greatest change of the wanted force [N/s]."""
STEADY_TIME = 0.5
"""Time after which a wanted force counts as steady [s]."""


class Phase(StrEnum):
    """What the tool does."""

    APPROACH = "approach"
    GRIND = "grind"
    LIFT = "lift"
    TRAVEL = "travel"
    DONE = "done"
    STOPPED = "stopped"


@dataclass(frozen=True)
class Sample:
    """What is known after a period.

    Attributes
    ----------
    time : float
        [s]
    phase : Phase
    wanted, force, measured : float
        Wanted force, force on the workpiece, and what the sensor tells of it [N].
    piston, offset : float
        Position of the piston, and offset of the arm by its controller [m].
    pressure : float
        [Pa]
    speed : float
        Of the spindle [rad/s].
    torque : float
        [N m]
    wear : float
        Share of the layer that is worn off.
    x, y : float
        Place of the contact [m].
    """

    time: float
    phase: Phase
    wanted: float
    force: float
    measured: float
    piston: float
    offset: float
    pressure: float
    speed: float
    torque: float
    wear: float
    x: float
    y: float


class Grinding:
    """Run over lines, advanced by `step`.

    Parameters
    ----------
    cell : Cell
    controller : ForceController
    lines : sequence of Line
    tools : sequence of sequence of Tool
        Of the points of each line; see `tools_along`.
    ramp : float
        Greatest change of the wanted force [N/s].
    is_supervised : bool
        Whether the tool is lifted off when something is wrong; else only when the sensor fails.
    """

    def __init__(
        self,
        cell: Cell,
        controller: ForceController,
        lines: Sequence[Line],
        tools: Sequence[Sequence[Tool]],
        ramp: float = RAMP_RATE,
        is_supervised: bool = True,
    ) -> None:
        self.cell = cell
        self.problem = ""
        self.phase = Phase.TRAVEL if lines else Phase.DONE
        self._controller, self._lines, self._tools = controller, lines, tools
        self._ramp, self._is_supervised = ramp, is_supervised
        self._supervisor = Supervisor(cell.parameters, controller.mode)
        self._line = -1
        self._wait = 0.0
        self._travelled = 0.0
        self._command = Command(0.0)
        self._clear_retreat = cell.parameters.actuator.stroke + cell.parameters.safety.standoff

    @property
    def line(self) -> int:
        """Return the number of the line, from 0."""
        return max(self._line, 0)

    @property
    def place_on_line(self) -> tuple[int, float]:
        """Return the segment of the line that the contact is on, from 0, and the share of it that is done."""
        return self._segment() if self._line >= 0 and self.phase is not Phase.DONE else (0, 0.0)

    @property
    def is_over(self) -> bool:
        """Return whether there is nothing more to do."""
        return self.phase in (Phase.DONE, Phase.STOPPED)

    def stop(self, problem: str) -> None:
        """Lift the tool off and stop, because of a problem."""
        if not self.is_over and not self.problem:
            self.problem = f"{problem} (at {self.cell.time:.3f} s, line {self.line + 1})"
            if self.phase is Phase.TRAVEL:
                self.phase = Phase.STOPPED
            else:
                self.phase = Phase.LIFT

    def step(self) -> Sample:
        """Advance by one period."""
        if self.is_over:
            return self._sample()
        if self.phase is Phase.TRAVEL:
            self._travel()
            return self._sample()
        tool = self._tool()
        measured = self.cell.step(self._command, tool)
        if self.phase is Phase.APPROACH:
            self._approach(measured, tool)
        elif self.phase is Phase.GRIND:
            self._grind(measured, tool)
        else:
            self._lift(tool)
        self._measured = measured.force
        return self._sample()

    _wanted = 0.0
    _measured = 0.0
    _along = 0.0
    _retreat = 0.0
    _steady = 0.0
    _place = (0.0, 0.0)

    def _travel(self) -> None:
        """Wait while the arm moves to the next line, and begin it."""
        self.cell.time += PERIOD
        self._wait -= PERIOD
        if self._wait > 0.0:
            return
        self._line += 1
        if self._line == len(self._lines):
            self.phase = Phase.DONE
            return
        self._along, self._steady = 0.0, 0.0
        self._wanted = self._measured = 0.0
        safety, actuator = self.cell.parameters.safety, self.cell.parameters.actuator
        is_free = self._controller.mode is ValveMode.OPEN
        position = actuator.stroke if is_free else 0.5 * actuator.stroke
        self._retreat = position - 0.5 * actuator.stroke + safety.standoff
        tool = self._tool()
        weight = self.cell.weight_at(tool)
        pressure = (weight + (safety.touch_force if is_free else 0.0)) / actuator.area
        self._command = Command(pressure)
        self.cell.put(position, pressure, tool)
        self._supervisor.begin()
        self.phase = Phase.APPROACH

    def _approach(self, measured: Measurement, tool: Tool) -> None:
        safety = self.cell.parameters.safety
        problem = self._supervisor.sensor_problem(measured, self.cell.time)
        if problem:
            self.stop(problem)
            return
        touches = measured.force > 0.5 * safety.touch_force
        has_arrived = self._retreat <= 0.0
        if not touches and not has_arrived:
            self._retreat = max(self._retreat - safety.approach_speed * PERIOD, 0.0)
        elif not touches and self._controller.mode is ValveMode.OPEN:
            self.stop("there is no contact where the workpiece should be")
        else:
            self._wanted = min(max(measured.force, 0.0), safety.touch_force)
            self._controller.begin(measured, self._command)
            self.phase = Phase.GRIND

    def _grind(self, measured: Measurement, tool: Tool) -> None:
        line = self._lines[self._line]
        safety = self.cell.parameters.safety
        self._retreat = max(self._retreat - safety.approach_speed * PERIOD, 0.0)
        index, share = self._segment()
        force = float(line.forces[index] + share * (line.forces[index + 1] - line.forces[index]))
        step = self._ramp * PERIOD
        change = min(max(force - self._wanted, -step), step)
        self._wanted += change
        self._steady = self._steady + PERIOD if abs(change) < 1e-3 * step else 0.0
        now = Situation(self.cell.time, self._wanted, self._steady > STEADY_TIME, self.cell.torque, self.cell.wear)
        problem = (
            self._supervisor.problem(measured, now)
            if self._is_supervised
            else self._supervisor.sensor_problem(measured, now.time)
        )
        if problem:
            self.stop(problem)
            return
        self._command = self._controller.step(self._wanted, measured)
        self._along += PERIOD * float(line.feeds[index] + share * (line.feeds[index + 1] - line.feeds[index]))
        if self._along >= self._line_lengths()[-1]:
            self.phase = Phase.LIFT

    def _lift(self, tool: Tool) -> None:
        """Draw the piston back and the arm away until the disc is clear of the workpiece."""
        actuator = self.cell.parameters.actuator
        self._wanted = 0.0
        self._retreat += LIFT_SPEED * PERIOD
        pressure = (self.cell.weight_at(tool) - LIFT_FORCE) / actuator.area
        self._command = Command(self._controller.limited(pressure), self._command.offset)
        if self._retreat < self._clear_retreat or self.cell.force > 0.0:
            return
        line = self._lines[self._line]
        self._travelled += self._line_lengths()[-1]
        if self.problem:
            self.phase = Phase.STOPPED
            return
        self.phase = Phase.TRAVEL
        if self._line + 1 < len(self._lines):
            away = self._lines[self._line + 1].points[0] - line.points[-1]
            self._wait = float((away @ away) ** 0.5) / TRAVEL_SPEED

    def _segment(self) -> tuple[int, float]:
        """Return the segment of the line that the contact is on, and the share of it that is done."""
        lengths = self._line_lengths()
        index = min(bisect.bisect_right(lengths, self._along) - 1, len(lengths) - 2)
        return index, min((self._along - lengths[index]) / (lengths[index + 1] - lengths[index]), 1.0)

    def _line_lengths(self) -> list[float]:
        if self._lengths[0] != self._line:
            self._lengths = (self._line, self._lines[self._line].lengths.tolist())
        return self._lengths[1]

    _lengths: tuple[int, list[float]] = (-1, [])

    def _tool(self) -> Tool:
        index, share = self._segment()
        one, two = self._tools[self._line][index], self._tools[self._line][index + 1]

        def between(first: float, second: float) -> float:
            return first + share * (second - first)

        tool = Tool(
            between(one.x, two.x),
            between(one.y, two.y),
            between(one.slope_x, two.slope_x),
            between(one.slope_y, two.slope_y),
            one.lean_x,
            one.lean_y,
            between(one.height, two.height),
            self._retreat,
            self._travelled + self._along,
        )
        self._place = (tool.x, tool.y)
        return tool

    def _sample(self) -> Sample:
        cell = self.cell
        touching = self.phase not in (Phase.TRAVEL, Phase.DONE, Phase.STOPPED)
        return Sample(
            cell.time, self.phase, self._wanted, cell.force if touching else 0.0, self._measured, cell.piston,
            cell.arm_offset, cell.pressure, cell.spindle_speed, cell.torque if touching else 0.0, cell.wear,
            *self._place,
        )  # fmt: skip
