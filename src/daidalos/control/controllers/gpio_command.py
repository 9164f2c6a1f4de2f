"""GPIO controller: commands of inputs and outputs by name, and their states."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from daidalos.common.parameters import ParameterError, Parameters, parameter, per_name
from daidalos.control.contracts import Controller, Subscription
from daidalos.samples.controllers import InterfaceGroupsCommand, InterfaceGroupsSample
from daidalos.samples.sensors import Sample


@dataclass(frozen=True)
class GpioInterfaces(Parameters):
    """Interfaces of one GPIO."""

    interfaces: tuple[str, ...] = parameter(
        (), "Names of the interfaces, without that of the GPIO.", unique=True, read_only=True
    )


@dataclass(frozen=True)
class GpioCommandParameters(Parameters):
    """Parameters of the GPIO controller, as ROS names them."""

    gpios: tuple[str, ...] = parameter((), "Names of the GPIOs.", not_empty=True, unique=True, read_only=True)
    command_interfaces: Mapping[str, GpioInterfaces] = per_name(GpioInterfaces, by="gpios")
    state_interfaces: Mapping[str, GpioInterfaces] = per_name(GpioInterfaces, by="gpios")


class GpioCommandController(Controller):
    """Controller that sets GPIOs by ``~/commands`` and publishes their states on ``~/gpio_states``.

    Where no state interfaces are given, all that the hardware has of the GPIOs are published.
    """

    names = ("gpio_controllers/GpioCommandController",)
    Parameters = GpioCommandParameters
    parameters: GpioCommandParameters

    def configure(self) -> None:
        """Set the interface names."""
        p = self.parameters
        self.command_names = _full_names(p.command_interfaces)
        self.state_names = _full_names(p.state_interfaces) or tuple(
            name for name in self.context.state_names if name.rpartition("/")[0] in p.gpios
        )
        if not self.command_names and not self.state_names:
            raise ParameterError(
                "gpios", f"names {', '.join(p.gpios)}, of which there are no command interfaces and no states"
            )
        self._column = {name: column for column, name in enumerate(self.command_names)}
        self._states = {
            gpio: [
                (name.rpartition("/")[2], column) for column, name in enumerate(self.state_names) if _is_of(name, gpio)
            ]
            for gpio in p.gpios
        }
        self._wanted: np.ndarray | None = None

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """States of the GPIOs."""
        return {"~/gpio_states": InterfaceGroupsSample}

    @property
    def subscriptions(self) -> Mapping[str, Subscription]:
        """Commands, where there are command interfaces."""
        return {"~/commands": Subscription(InterfaceGroupsCommand, self._take)} if self.command_names else {}

    def _take(self, command: InterfaceGroupsCommand) -> None:
        """Set the commanded values; a command whose names and values differ in number changes nothing."""
        wanted = np.full(len(self.command_names), np.nan) if self._wanted is None else self._wanted.copy()
        if len(command.groups) != len(command.values):
            self.context.warn(
                f"command has {len(command.groups)} groups and values of {len(command.values)}; it is not executed"
            )
            return
        for gpio, (names, values) in zip(command.groups, command.values, strict=True):
            if len(names) != len(values):
                self.context.warn(
                    f"command of '{gpio}' has {len(names)} interfaces and {len(values)} values; it is not executed"
                )
                return
            for name, value in zip(names, values, strict=True):
                column = self._column.get(f"{gpio}/{name}")
                if column is None:
                    known = ", ".join(self.command_names)
                    self.context.warn(f"'{gpio}/{name}' is not commanded by '{self.context.name}'; it has {known}")
                else:
                    wanted[column] = value
        self._wanted = wanted

    def activate(self, now_ns: int) -> None:
        """Forget commands from before."""
        self._wanted = None

    def deactivate(self) -> None:
        """Forget the command."""
        self._wanted = None

    def update(self, now_ns: int, period: float) -> Iterable[Sample]:
        """Write the commanded values, and return the states."""
        if self._wanted is not None:
            unknown = np.isnan(self._wanted)
            self.commands.write(np.where(unknown, self.commands.read(), self._wanted))
        if not self.context.has_subscribers("~/gpio_states"):
            return
        values = self.states.read().tolist()
        yield InterfaceGroupsSample(
            stamp_ns=now_ns,
            topic="~/gpio_states",
            frame_id="",
            groups={gpio: {name: values[column] for name, column in rows} for gpio, rows in self._states.items()},
        )


def _full_names(interfaces: Mapping[str, GpioInterfaces]) -> tuple[str, ...]:
    return tuple(f"{gpio}/{name}" for gpio, given in interfaces.items() for name in given.interfaces)


def _is_of(interface: str, gpio: str) -> bool:
    return interface.rpartition("/")[0] == gpio
