"""Position control, as the counter-example: the arm presses by the stiffness of the contact that it assumes."""

from __future__ import annotations

from dataclasses import dataclass

from daidalos.common.parameters import Parameters, parameter
from daidalos.industry.grinding.force_control import Command, ForceController, Measurement, ValveMode
from daidalos.industry.grinding.settings import ActuatorParameters


@dataclass(frozen=True)
class PositionParameters(Parameters):
    """Parameters of ``position``."""

    stiffness: float = parameter(1e5, "Stiffness of the contact that is assumed.", unit="N/m", above=0.0)


class Position(ForceController):
    """Blocks the piston and moves the arm to where an exact path would give the wanted force."""

    names = ("position",)
    settings_class = PositionParameters
    mode = ValveMode.LOCKED

    def __init__(self, settings: PositionParameters, actuator: ActuatorParameters, period: float) -> None:
        super().__init__(settings, actuator, period)
        self._settings = settings
        self._pressure = 0.0

    def begin(self, measured: Measurement, command: Command) -> None:
        """Keep the pressure."""
        self._pressure = command.pressure

    def step(self, wanted: float, measured: Measurement) -> Command:
        """Return the offset of the arm."""
        return Command(self._pressure, wanted / self._settings.stiffness)
