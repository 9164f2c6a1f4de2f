"""Contract of hardware between controllers and motors."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from daidalos.control.interfaces import Interfaces
from daidalos.description.ros2_control import ComponentInfo, HardwareInfo, InterfaceInfo


def _ignore(line: str) -> None:
    """Ignore a line for the user."""


@dataclass(frozen=True)
class HardwareContext:
    """Context of hardware.

    Parameters
    ----------
    update_rate : float
        Of the manager [Hz].
    warn : callable
        Takes a line for the user.
    """

    update_rate: float = 100.0
    warn: Callable[[str], None] = _ignore


class Hardware:
    """Hardware of a robot or of a part of it.

    Subclass it for your own robot: read sensors into `states` in `read`, send `commands` in `write`. Name the
    class in ``<plugin>`` as ``my_package.my_module.MyRobot``, or by an entry point of the group
    ``daidalos.hardware``. Raise `HardwareError` where something fails.

    Parameters
    ----------
    info : HardwareInfo
        What the robot's ``<ros2_control>`` element says.
    context : HardwareContext

    Attributes
    ----------
    names : tuple of str
        Class attribute: the plugins that it stands for.
    commands, states : Interfaces
        Named values, SI. Commands are NaN as long as nobody commands them.
    """

    names: ClassVar[tuple[str, ...]] = ()

    def __init__(self, info: HardwareInfo, context: HardwareContext | None = None) -> None:
        self.info = info
        self.context = context or HardwareContext()
        self.commands = Interfaces(info.command_names)
        self.states = Interfaces(info.state_names)

    def configure(self) -> None:
        """Connect with the robot; called from ``unconfigured``."""

    def cleanup(self) -> None:
        """Disconnect; called on the way back to ``unconfigured``, and at the end."""

    def activate(self) -> None:
        """Power up; commands count from now on."""

    def deactivate(self) -> None:
        """Stop motion."""

    def read(self, now_ns: int, period: float) -> None:
        """Update `states` from the hardware.

        Parameters
        ----------
        now_ns : int
            [ns].
        period : float
            Since the last reading [s].
        """

    def write(self, now_ns: int, period: float) -> None:
        """Send `commands`; see `read`."""

    def prepare_switch(self, start: Sequence[str], stop: Sequence[str]) -> None:
        """Refuse, with a `HardwareError`, command interfaces that cannot be claimed or released together."""

    def switch(self, start: Sequence[str], stop: Sequence[str]) -> None:
        """Switch command interfaces; those in `stop` that are not in `start` are no longer used."""

    def set_initial(self) -> None:
        """Set the states and commands to the initial values that the description gives."""
        for component in self.info.components:
            for interfaces, values, kind in (
                (component.commands, self.commands, "command"),
                (component.states, self.states, "state"),
            ):
                for interface in interfaces:
                    value = initial_value(component, interface, kind)
                    if not np.isnan(value):
                        values[f"{component.name}/{interface.name}"] = value


def initial_value(component: ComponentInfo, interface: InterfaceInfo, kind: str) -> float:
    """Return the initial value of an interface, NaN where none is given.

    A state without a value of its own starts where the command of its name does.
    """
    if not np.isnan(interface.initial_value) or kind == "command":
        return interface.initial_value
    return next((one.initial_value for one in component.commands if one.name == interface.name), float("nan"))
