"""Nodes of simulation plugins, such as controller managers."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol

from rclpy.context import Context

from daidalos.simulation.plugins.ros2_control import Ros2Control

if TYPE_CHECKING:
    from daidalos.simulation import Simulation
    from daidalos.simulation.contracts import Component


class Companion(Protocol):
    """Node that accompanies a plugin."""

    def publish(self) -> None:
        """Publish what there is to say since the last time; called on the simulation's thread."""

    def close(self) -> None:
        """End."""


class Companions:
    """Manager of the nodes of plugins, started and stopped as models are added and removed.

    Parameters
    ----------
    context : Context
        Of their nodes.
    warn : callable
        Called with a line for the user where one cannot be started.
    """

    def __init__(self, context: Context, warn: Callable[[str], None]) -> None:
        self._context = context
        self._warn = warn
        self._known: dict[int, tuple[Component, Companion | None]] = {}

    def follow(self, simulation: Simulation) -> None:
        """Update the nodes to the current models; called on the simulation's thread."""
        present = {id(component): component for component in simulation.components if type(component) in _MAKERS}
        for key in [key for key in self._known if key not in present]:
            self._end(key)
        for key, component in present.items():
            if key not in self._known:
                self._known[key] = (component, self._make(component))

    def publish(self) -> None:
        """Publish pending samples of all nodes; called after the clock was published."""
        for _, companion in self._known.values():
            if companion is not None:
                companion.publish()

    def close(self) -> None:
        """End all."""
        for key in list(self._known):
            self._end(key)

    def _make(self, component: Component) -> Companion | None:
        from daidalos.common.extensions import ExtensionError
        from daidalos.control.errors import ControlError

        try:
            return _MAKERS[type(component)](component, self._context)
        except (ControlError, ExtensionError, ValueError, RuntimeError) as error:  # a parameter file that is not valid
            self._warn(f"the controllers of '{component.context.model_name}' cannot be started: {error}")
            return None

    def _end(self, key: int) -> None:
        _, companion = self._known.pop(key)
        if companion is not None:
            companion.close()


def _controller_manager(component: Any, context: Context) -> Companion:
    from daidalos.nodes.controller_manager._simulated import SimulatedManager

    return SimulatedManager(component, context)


_MAKERS: dict[type, Callable[[Any, Context], Companion]] = {Ros2Control: _controller_manager}
