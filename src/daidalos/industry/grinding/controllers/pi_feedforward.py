"""PI control of the force, with feed-forward of the wanted force and the weight."""

from __future__ import annotations

from dataclasses import dataclass

from daidalos.common.parameters import Parameters, parameter
from daidalos.industry.grinding.force_control import Command, ForceController, Measurement
from daidalos.industry.grinding.settings import ActuatorParameters


@dataclass(frozen=True)
class PiFeedforwardParameters(Parameters):
    """Parameters of ``pi``."""

    proportional: float = parameter(0.3, "Force per error of the force.", minimum=0.0)
    integral: float = parameter(6.0, "Force per error of the force and time.", unit="1/s", above=0.0)
    feedforward: float = parameter(
        0.5, "Share of the wanted force that is commanded at once.", minimum=0.0, maximum=1.5
    )


class PiFeedforward(ForceController):
    """Commands the wanted force at once, and what errors tell to be missing."""

    names = ("pi",)
    settings_class = PiFeedforwardParameters

    def __init__(self, settings: PiFeedforwardParameters, actuator: ActuatorParameters, period: float) -> None:
        super().__init__(settings, actuator, period)
        self._settings = settings
        self._sum = 0.0

    def begin(self, measured: Measurement, command: Command) -> None:
        """Choose the sum of the errors so that the pressure stays as it is."""
        force = command.pressure * self.actuator.area
        self._sum = force - measured.weight - self._settings.feedforward * measured.force

    def step(self, wanted: float, measured: Measurement) -> Command:
        """Return the pressure."""
        error = wanted - measured.force
        total = self._sum + self._settings.integral * self.period * error
        force = measured.weight + self._settings.feedforward * wanted + self._settings.proportional * error + total
        pressure = self.limited(force / self.actuator.area)
        if pressure == force / self.actuator.area:  # the sum waits while the valve is at its limit
            self._sum = total
        return Command(pressure)
