"""Controllers in the manager, from loading to unloading."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from daidalos.common.rate_gate import RateGate
from daidalos.control.component import UNCONFIGURED
from daidalos.control.contracts import Controller, ControllerContext
from daidalos.control.errors import StateError
from daidalos.control.interfaces import Interfaces
from daidalos.control.switching import Candidate

Reader = Callable[[type], object]
"""Makes an instance of a controller's parameter class."""


@dataclass(eq=False)
class LoadedController:
    """Controller in the manager.

    Parameters
    ----------
    name, type_name : str
    kind : type
        The controller's class.
    read_parameters : callable
        Makes an instance of its parameter class, whenever it is configured.
    context : ControllerContext
    fallbacks : tuple of str
        Controllers to start when this one fails.
    state : str
    controller : Controller or None
        Once it is configured.
    """

    name: str
    type_name: str
    kind: type[Controller]
    read_parameters: Reader
    context: ControllerContext
    fallbacks: tuple[str, ...] = ()
    state: str = UNCONFIGURED
    controller: Controller | None = None
    references: Interfaces = field(default_factory=Interfaces)
    exported: Interfaces = field(default_factory=Interfaces)
    gate: RateGate | None = None
    updated_ns: int = -1

    @property
    def running(self) -> Controller:
        """Configured controller; raises an error otherwise."""
        if self.controller is None:
            raise StateError(f"controller '{self.name}' is not configured")
        return self.controller

    @property
    def candidate(self) -> Candidate:
        """Candidate for a switch."""
        return Candidate(
            state=self.state,
            commands=self.controller.command_names if self.controller else (),
            states=self.controller.state_names if self.controller else (),
            references=self.references.names,
            exported=self.exported.names,
        )


def prefixed(name: str, interfaces: Interfaces) -> Interfaces:
    """Return the same values under names prefixed by the controller's."""
    result = Interfaces(f"{name}/{one}" for one in interfaces.names)
    result.values = interfaces.values
    return result
