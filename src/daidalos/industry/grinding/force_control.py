"""Contract of force controllers: what they are told, and what they command."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from enum import IntEnum
from typing import ClassVar

from daidalos.common.parameters import Parameters
from daidalos.industry.grinding.settings import ActuatorParameters


class ValveMode(IntEnum):
    """State of the valve while a controller is on."""

    OPEN = 0
    """The pressure is commanded."""
    CLOSED = 1
    """The air in the cylinder is a spring, and the arm is moved."""
    LOCKED = 2
    """The piston is blocked, and the arm is moved."""


@dataclass(frozen=True)
class Measurement:
    """What the sensors tell in one period.

    Attributes
    ----------
    time : float
        [s]
    force : float
        Force on the workpiece: that of the sensor, without the weight that it carries [N].
    position, speed : float
        Of the piston [m], [m/s].
    weight : float
        Force of gravity against the piston, by the angle of the tool [N].
    """

    time: float
    force: float
    position: float
    speed: float
    weight: float


@dataclass(frozen=True)
class Command:
    """What is commanded for one period.

    Attributes
    ----------
    pressure : float
        Difference of the pressures in both chambers, positive towards the workpiece [Pa].
    offset : float
        Of the arm from its path, towards the workpiece [m].
    """

    pressure: float
    offset: float = 0.0


class ForceController(ABC):
    """Controller of the force on the workpiece, called once in a period.

    Parameters
    ----------
    settings : Parameters
        Of the class `settings_class`.
    actuator : ActuatorParameters
        What is known of the actuator.
    period : float
        [s]
    """

    names: ClassVar[tuple[str, ...]] = ()
    settings_class: ClassVar[type[Parameters]] = Parameters
    mode: ClassVar[ValveMode] = ValveMode.OPEN

    def __init__(self, settings: Parameters, actuator: ActuatorParameters, period: float) -> None:
        self.actuator = actuator
        self.period = period

    @abstractmethod
    def begin(self, measured: Measurement, command: Command) -> None:
        """Take over from a command at the first touch, without a jump."""

    @abstractmethod
    def step(self, wanted: float, measured: Measurement) -> Command:
        """Return the command for a wanted force [N]."""

    def limited(self, pressure: float) -> float:
        """Return a pressure within the limits of the valve [Pa]."""
        limit = self.actuator.max_pressure
        return min(max(pressure, -limit), limit)
