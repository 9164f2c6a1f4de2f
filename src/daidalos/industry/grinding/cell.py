"""Simulated grinding cell: arm, actuator, grinder and workpiece, advanced by one period of the control."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from daidalos.common.errors import UserError
from daidalos.common.suggestions import hint
from daidalos.industry.grinding import contact_kernels, dynamics_kernels
from daidalos.industry.grinding.force_control import Command, Measurement, ValveMode
from daidalos.industry.grinding.height_field import Workpiece
from daidalos.industry.grinding.settings import GRAVITY, PERIOD, CellParameters

FAR = 1.0
"""Distance of the surface where the disc is beside the workpiece [m]."""
FIELD_STEPS = 4
"""Periods of the control between two updates of the contact and the removal."""


class FaultKind(StrEnum):
    """What can break in the cell."""

    SENSOR_STOPS = "sensor_stops"
    SENSOR_NAN = "sensor_nan"
    VALVE_STOPS = "valve_stops"


@dataclass(frozen=True)
class Fault:
    """Something that breaks at a time [s]."""

    kind: FaultKind
    time: float


def parse_fault(text: str) -> Fault:
    """Return the fault of a text such as ``sensor_nan@3.0``.

    Raises
    ------
    UserError
        Where there is no such fault, or its time is none.
    """
    kind, _, time = text.partition("@")
    if kind not in list(FaultKind):
        raise UserError(f"there is no fault '{kind}'{hint(kind, FaultKind)}")
    try:
        at = float(time)
    except ValueError:
        at = math.nan
    if not 0.0 <= at < math.inf:
        raise UserError(f"'{text}' is no fault; KIND@SECONDS is expected")
    return Fault(FaultKind(kind), at)


@dataclass(frozen=True)
class Tool:
    """Where the arm leads the disc.

    Attributes
    ----------
    x, y : float
        Place of the contact on the workpiece [m].
    slope_x, slope_y : float
        Of the surface there.
    lean_x, lean_y : float
        Unit vector from the centre of the disc to the contact: the disc leans over to there.
    height : float
        Of the centre of the disc at the first touch, on the surface that the path was made for [m].
    retreat : float
        Distance of the arm from its path, away from the workpiece [m].
    travelled : float
        Length of the path so far, for the errors of the arm [m].
    """

    x: float
    y: float
    slope_x: float
    slope_y: float
    lean_x: float
    lean_y: float
    height: float
    retreat: float
    travelled: float


class Cell:
    """Grinding cell.

    Parameters
    ----------
    parameters : CellParameters
    workpiece : Workpiece
        Copied; `surface` is what is ground.
    offset : float
        Distance of the contact from the centre of the disc [m].
    mode : ValveMode
    seed : int
        Of noise and phases.
    wear : float
        Share of the disc's layer that is worn off.
    """

    def __init__(
        self,
        parameters: CellParameters,
        workpiece: Workpiece,
        offset: float,
        mode: ValveMode = ValveMode.OPEN,
        seed: int = 0,
        wear: float = 0.0,
    ) -> None:
        self.parameters = parameters
        self.workpiece = workpiece
        self.surface = workpiece.surface.copy()
        self.mode = mode
        self.wear = wear
        self.time = 0.0
        self.removed = 0.0
        self.faults: tuple[Fault, ...] = ()
        self.force = self.torque = self.area = 0.0
        self._offset = offset
        self._rng = np.random.default_rng(seed)
        self._phases = self._rng.uniform(0.0, 2.0 * np.pi, 3)
        self._state = np.zeros(dynamics_kernels.STATES)
        self._state[dynamics_kernels.SPINDLE] = parameters.spindle.speed
        self._tables = np.zeros((3, contact_kernels.BINS + 1))
        self._out, self._removed = np.zeros(4), np.zeros(3)
        self._surface = np.array([FAR, FAR])
        self._target_surface = FAR
        self._disc, self._top = np.zeros(6), contact_kernels.BESIDE
        self._lever = parameters.disc.radius
        self._steps, self._force_sum = 0, 0.0
        self._pending: deque[Command] = deque()
        self._last: Measurement | None = None
        self._constants = _constants(parameters)

    @property
    def spindle_speed(self) -> float:
        """Return the speed of the spindle [rad/s]."""
        return float(self._state[dynamics_kernels.SPINDLE])

    @property
    def pressure(self) -> float:
        """Return the difference of the pressures in both chambers [Pa]."""
        return float(self._state[dynamics_kernels.PRESSURE])

    @property
    def piston(self) -> float:
        """Return the position of the piston [m]."""
        return float(self._state[dynamics_kernels.PISTON])

    @property
    def arm_offset(self) -> float:
        """Return the offset of the arm from its path [m]."""
        return float(self._state[dynamics_kernels.ARM])

    def weight_at(self, tool: Tool) -> float:
        """Return the force of gravity against the piston, m g cos(phi) with phi between its way and the upright [N]."""
        normal = np.array([-tool.slope_x, -tool.slope_y, 1.0])
        upright = float(self.workpiece.pose[2, :3] @ normal) / float(np.linalg.norm(normal))
        return -self.parameters.actuator.mass * GRAVITY * upright

    def put(self, position: float, pressure: float, tool: Tool) -> None:
        """Put the piston at rest somewhere, and the arm on its path, away from the workpiece."""
        state = dynamics_kernels
        self._state[[state.PISTON, state.PRESSURE]] = position, pressure
        self._state[[state.SPEED, state.SEAL, state.ARM, state.FILTER_RATE]] = 0.0
        self._state[state.FILTERED] = self.weight_at(tool)
        self._pending.clear()
        self._steps, self._force_sum, self._top = 0, 0.0, contact_kernels.BESIDE
        self._look(tool)
        self._surface[:] = self._target_surface

    def step(self, command: Command, tool: Tool) -> Measurement:
        """Advance by one period with a command, and measure."""
        if self._steps % FIELD_STEPS == 0:
            self._grind()
            self._surface[0] = self._surface[1]
            self._look(tool)
        begin = self._surface[0]
        ahead = (self._steps % FIELD_STEPS + 1) / FIELD_STEPS
        self._steps += 1
        before = begin + (self._target_surface - begin) * (ahead - 1.0 / FIELD_STEPS)
        span = np.array([before, begin + (self._target_surface - begin) * ahead])
        if ahead == 1.0:
            self._surface[1] = span[1]
        self._constants[12] = weight = self.weight_at(tool)
        delayed = self._delayed(command)
        dynamics_kernels.advance(
            self._state, self._constants, delayed, int(self.mode), 0.5 * self.parameters.actuator.stroke, span,
            self._tables[0], self._tables[2], self._lever, PERIOD, self._out,
        )  # fmt: skip
        self.time += PERIOD
        self.force, self.torque = float(self._out[0]), float(self._out[2])
        self._force_sum += self.force
        return self._measure(weight)

    def _look(self, tool: Tool) -> None:
        """Compute the table of the contact at the end of the next field period."""
        arm = self.parameters.arm
        phase = 2.0 * math.pi * tool.travelled / arm.error_length
        errors = (
            arm.angle_error * math.sin(1.3 * phase + self._phases[1]),
            arm.angle_error * math.sin(0.7 * phase + self._phases[2]),
        )
        self._disc = leaning_disc(self.parameters, tool, self._offset, errors)
        self._top = press(self.parameters, self.workpiece, self.surface, self._disc, self._tables)
        if self._top == contact_kernels.BESIDE:
            self._target_surface = self._surface[1] = self._surface[0] = FAR
            self._tables[:] = 0.0
            return
        cosine = 1.0 / math.sqrt(1.0 + float(self._disc[2]) ** 2 + float(self._disc[3]) ** 2)
        # The errors turn the face about the place of the contact, not about the centre of the disc.
        lifted = tool.height - self._top - (errors[0] * tool.lean_x + errors[1] * tool.lean_y) * self._offset
        error = arm.position_error * math.sin(phase + self._phases[0])
        self._target_surface = 0.5 * self.parameters.actuator.stroke + lifted * cosine - error + tool.retreat

    @property
    def preston(self) -> float:
        """Return the removed depth per pressure and way of the disc as it is worn [1/Pa]."""
        return self.parameters.disc.preston * (1.0 - self.parameters.disc.dulling * min(self.wear, 1.0))

    def _grind(self) -> None:
        """Remove what the mean force of the last field period grinds off, and wear the disc."""
        force, self._force_sum = self._force_sum / FIELD_STEPS, 0.0
        if force <= 0.0 or self._top == contact_kernels.BESIDE:
            self.area = 0.0
            return
        face = float(np.interp(force, self._tables[2], self._tables[1]))
        rate = self.preston * self.parameters.contact.face_stiffness * self.spindle_speed * FIELD_STEPS * PERIOD
        piece = self.workpiece
        contact_kernels.remove(
            self.surface, piece.origin, piece.resolution, self._disc, self._top - face, rate, self._removed
        )
        self.removed += float(self._removed[0])
        self._lever, self.area = float(self._removed[1]), float(self._removed[2])
        self.wear += float(self._removed[0]) / self.parameters.disc.life

    def _delayed(self, command: Command) -> NDArray[np.float64]:
        """Return what comes out of the dead times of valve and arm."""
        valve, arm = (round(one / PERIOD) for one in (self.parameters.actuator.valve_delay, self.parameters.arm.delay))
        if not self._pending:
            self._pending.extend([Command(self.pressure, self.arm_offset)] * (max(valve, arm) + 1))
        self._pending.popleft()
        self._pending.append(command)
        if not self._broken(FaultKind.VALVE_STOPS):
            self._valve_command = self._pending[-1 - valve].pressure
        return np.array([self._valve_command, self._pending[-1 - arm].offset])

    def _measure(self, weight: float) -> Measurement:
        sensor = self.parameters.sensor
        if self._broken(FaultKind.SENSOR_STOPS) and self._last is not None:
            return self._last
        force = float(self._out[3]) - weight + sensor.force_noise * self._rng.normal()
        if self._broken(FaultKind.SENSOR_NAN):
            force = math.nan
        position = self.piston + sensor.position_noise * self._rng.normal()
        self._last = Measurement(self.time, force, position, float(self._state[dynamics_kernels.SPEED]), weight)
        return self._last

    _valve_command = 0.0

    def _broken(self, kind: FaultKind) -> bool:
        return any(one.kind is kind and self.time >= one.time for one in self.faults)


def disc_at(parameters: CellParameters, x: float, y: float, slope_x: float, slope_y: float) -> NDArray[np.float64]:
    """Return a disc as the kernels of the contact take it: centre [m], slopes of its face, and radii [m]."""
    return np.array([x, y, slope_x, slope_y, parameters.disc.radius, parameters.disc.inner_radius])


def leaning_disc(
    parameters: CellParameters, tool: Tool, offset: float, errors: tuple[float, float] = (0.0, 0.0)
) -> NDArray[np.float64]:
    """Return the disc at a tool's place, for the kernels of the contact.

    Parameters
    ----------
    parameters : CellParameters
    tool : Tool
    offset : float
        Distance of the contact from the centre of the disc [m].
    errors : tuple of float
        Added to the slopes of the face along x and y.
    """
    lean = parameters.disc.lean
    return disc_at(
        parameters,
        tool.x - tool.lean_x * offset,
        tool.y - tool.lean_y * offset,
        tool.slope_x - lean * tool.lean_x + errors[0],
        tool.slope_y - lean * tool.lean_y + errors[1],
    )


def press(
    parameters: CellParameters,
    piece: Workpiece,
    heights: NDArray[np.float64],
    disc: NDArray[np.float64],
    tables: NDArray[np.float64],
) -> float:
    """Compute depths, depths of the face and forces (3, BINS + 1) of a disc on heights; return the first touch [m]."""
    contact = parameters.contact
    is_hertz = contact.law == "hertz"
    stiffness = np.array([contact.hertz_stiffness if is_hertz else contact.stiffness, contact.face_stiffness])
    depths, faces, forces = tables
    return contact_kernels.press(
        heights, piece.origin, piece.resolution, disc, stiffness, is_hertz, depths, faces, forces
    )


def _constants(parameters: CellParameters) -> NDArray[np.float64]:
    """Return the constants of `dynamics_kernels.advance`, without gravity."""
    actuator, arm, spindle = parameters.actuator, parameters.arm, parameters.spindle
    return np.array(
        [
            actuator.area, actuator.mass, actuator.stroke, actuator.valve_time, actuator.coulomb_friction,
            actuator.static_friction, actuator.stribeck_speed, actuator.viscous_friction, actuator.seal_stiffness,
            actuator.closed_stiffness, arm.time_constant, arm.max_speed, 0.0, parameters.contact.damping,
            spindle.speed, spindle.droop, spindle.time_constant, spindle.unbalance, parameters.disc.friction,
            2.0 * math.pi * parameters.sensor.cut_off,
        ]
    )  # fmt: skip
