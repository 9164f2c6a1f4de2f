"""Integral control of the force (Volpe and Khosla, 1993)."""

from __future__ import annotations

from dataclasses import dataclass

from daidalos.common.parameters import Parameters, parameter
from daidalos.industry.grinding.force_control import Command, ForceController, Measurement
from daidalos.industry.grinding.settings import ActuatorParameters


@dataclass(frozen=True)
class IntegralParameters(Parameters):
    """Parameters of ``integral``."""

    integral: float = parameter(4.5, "Force per error of the force and time.", unit="1/s", above=0.0)


class Integral(ForceController):
    """Commands the integral of the error, beside the weight."""

    names = ("integral",)
    settings_class = IntegralParameters

    def __init__(self, settings: IntegralParameters, actuator: ActuatorParameters, period: float) -> None:
        super().__init__(settings, actuator, period)
        self._settings = settings
        self._sum = 0.0

    def begin(self, measured: Measurement, command: Command) -> None:
        """Start from the pressure as it is."""
        self._sum = command.pressure * self.actuator.area - measured.weight

    def step(self, wanted: float, measured: Measurement) -> Command:
        """Return the pressure."""
        total = self._sum + self._settings.integral * self.period * (wanted - measured.force)
        force = measured.weight + total
        pressure = self.limited(force / self.actuator.area)
        if pressure == force / self.actuator.area:
            self._sum = total
        return Command(pressure)
