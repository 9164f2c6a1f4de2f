"""Admittance control: the arm yields to the force like a damped mass, with the cylinder's air as a spring."""

from __future__ import annotations

from dataclasses import dataclass

from daidalos.common.parameters import Parameters, parameter
from daidalos.industry.grinding.force_control import Command, ForceController, Measurement, ValveMode
from daidalos.industry.grinding.settings import ActuatorParameters


@dataclass(frozen=True)
class AdmittanceParameters(Parameters):
    """Parameters of ``admittance``."""

    mass: float = parameter(20.0, "Mass that the arm seems to have.", unit="kg", above=0.0)
    damping: float = parameter(1100.0, "Damping that the arm seems to have.", unit="N s/m", above=0.0)
    max_offset: float = parameter(0.02, "Greatest offset of the arm from its path.", unit="m", above=0.0)


class Admittance(ForceController):
    """Moves the arm by the error of the force."""

    names = ("admittance",)
    settings_class = AdmittanceParameters
    mode = ValveMode.CLOSED

    def __init__(self, settings: AdmittanceParameters, actuator: ActuatorParameters, period: float) -> None:
        super().__init__(settings, actuator, period)
        self._settings = settings
        self._command = Command(0.0)
        self._speed = 0.0

    def begin(self, measured: Measurement, command: Command) -> None:
        """Start at rest, with pressure and offset as they are."""
        self._command, self._speed = command, 0.0

    def step(self, wanted: float, measured: Measurement) -> Command:
        """Return the offset of the arm."""
        own = self._settings
        acceleration = (wanted - measured.force - own.damping * self._speed) / own.mass
        self._speed += self.period * acceleration
        offset = self._command.offset + self.period * self._speed
        if abs(offset) > own.max_offset:
            offset, self._speed = self._command.offset, 0.0
        self._command = Command(self._command.pressure, offset)
        return self._command
