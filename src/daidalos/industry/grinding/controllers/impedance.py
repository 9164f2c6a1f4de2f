"""Impedance control: the piston as a spring and damper about a place that follows the error of the force."""

from __future__ import annotations

from dataclasses import dataclass

from daidalos.common.parameters import Parameters, parameter
from daidalos.industry.grinding.force_control import Command, ForceController, Measurement
from daidalos.industry.grinding.settings import ActuatorParameters


@dataclass(frozen=True)
class ImpedanceParameters(Parameters):
    """Parameters of ``impedance``."""

    stiffness: float = parameter(800.0, "Stiffness of the spring.", unit="N/m", above=0.0)
    damping: float = parameter(40.0, "Damping.", unit="N s/m", minimum=0.0)
    adaptation: float = parameter(
        8.0, "Rate at which the spring's place follows the error of the force.", unit="1/s", minimum=0.0
    )
    response: float = parameter(
        0.09, "Time constant with which the force is expected to follow the wanted one.", unit="s", above=0.0
    )


class Impedance(ForceController):
    """Commands a spring that presses with the wanted force at its place, which is adapted."""

    names = ("impedance",)
    settings_class = ImpedanceParameters

    def __init__(self, settings: ImpedanceParameters, actuator: ActuatorParameters, period: float) -> None:
        super().__init__(settings, actuator, period)
        self._settings = settings
        self._place = self._expected = 0.0

    def begin(self, measured: Measurement, command: Command) -> None:
        """Choose the place of the spring so that the pressure stays as it is."""
        force = command.pressure * self.actuator.area - measured.weight - measured.force
        self._place = measured.position + force / self._settings.stiffness
        self._expected = measured.force

    def step(self, wanted: float, measured: Measurement) -> Command:
        """Return the pressure."""
        own = self._settings
        self._expected += self.period / (own.response + self.period) * (wanted - self._expected)
        self._place += own.adaptation * self.period * (self._expected - measured.force) / own.stiffness
        spring = own.stiffness * (self._place - measured.position) - own.damping * measured.speed
        return Command(self.limited((wanted + measured.weight + spring) / self.actuator.area))
