"""Controller manager: hardware, controllers, claims of interfaces, and the control cycle."""

from __future__ import annotations

import logging
import traceback
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import TypeVar

from daidalos.common.extensions import find
from daidalos.common.rate_gate import RateGate
from daidalos.control.component import ACTIVE, FINALIZED, INACTIVE, UNCONFIGURED, Component
from daidalos.control.contracts import ControllerContext, Hardware
from daidalos.control.errors import ControlError, HardwareError, StateError, SwitchError, UnknownError
from daidalos.control.extensions import CONTROLLERS
from daidalos.control.interfaces import Interfaces
from daidalos.control.loaded_controller import LoadedController, Reader, prefixed
from daidalos.control.switcher import Switcher
from daidalos.control.switching import Strictness, Switch
from daidalos.samples.sensors import Sample

_log = logging.getLogger(__name__)
T = TypeVar("T")


class ControllerManager:
    """Manager of controllers and hardware.

    It has no clock and no thread: the caller calls `update` in each cycle, and all else between two of them.

    Parameters
    ----------
    hardware : iterable of Hardware
    update_rate : float
        Cycles in a second of the caller's clock.
    initial_states : mapping
        State by name of hardware that should not be active at once.
    enforce_limits : bool
        Whether commands are kept within the limits of joints.
    log : callable or None
        Takes a line for the user; None logs it.

    Attributes
    ----------
    components : dict of Component
    controllers : dict of LoadedController
    time_ns : int
        Of the last cycle.
    """

    def __init__(
        self,
        hardware: Iterable[Hardware] = (),
        update_rate: float = 100.0,
        initial_states: Mapping[str, str] | None = None,
        enforce_limits: bool = True,
        log: Callable[[str], None] | None = None,
    ) -> None:
        self.update_rate = update_rate
        self.components: dict[str, Component] = {}
        self.controllers: dict[str, LoadedController] = {}
        self.time_ns = 0
        self._log = _log.warning if log is None else log
        self._switcher = Switcher(self.components, self.controllers, self._log)
        self._started = False
        for one in hardware:
            self._add(Component(one, enforce_limits), (initial_states or {}).get(one.info.name, ACTIVE))

    def _add(self, component: Component, state: str) -> None:
        for kind in ("command", "state"):
            taken = {name: one.name for one in self.components.values() for name in one.interfaces(kind).names}
            for name in component.interfaces(kind).names:
                if name in taken:
                    raise ControlError(f"hardware '{component.name}' and '{taken[name]}' both have {kind} {name}")
        self.components[component.name] = component
        try:
            component.go_to(state)
        except HardwareError as error:
            self._log(f"hardware '{component.name}' cannot be made {state}: {error}")

    # Hardware

    @property
    def state_names(self) -> tuple[str, ...]:
        """Names of all state interfaces of the hardware."""
        return tuple(name for one in self.components.values() for name in one.hardware.states.names)

    def set_component_state(self, name: str, target: str) -> None:
        """Bring hardware to a state; controllers that need it are stopped.

        Raises
        ------
        UnknownError, StateError, HardwareError
        """
        component = _find(self.components, "hardware", name)
        kept = {ACTIVE: ("command", "state"), INACTIVE: ("state",)}.get(target, ())
        self._switcher.stop_users(component, kept, f"hardware '{name}' becomes {target}", self.time_ns)
        component.go_to(target)

    def claimed(self, interface: str) -> str:
        """Return the active controller that claims a command interface, or an empty string."""
        return next((one.name for one in self._switcher.active if interface in one.running.command_names), "")

    # Controllers

    def load(
        self,
        name: str,
        type_name: str,
        read_parameters: Reader,
        context: ControllerContext | None = None,
        fallbacks: Sequence[str] = (),
    ) -> LoadedController:
        """Add a controller.

        Parameters
        ----------
        name : str
        type_name : str
            Such as ``joint_state_broadcaster/JointStateBroadcaster``.
        read_parameters : callable
            See `LoadedController`.
        context : ControllerContext or None
            Its rate is brought down to the manager's; 0 is the manager's.
        fallbacks : sequence of str

        Raises
        ------
        StateError
            When there is one of that name.
        ExtensionError
            When there is no such type, or its class cannot be used.
        """
        if name in self.controllers:
            raise StateError(f"a controller '{name}' is loaded already")
        context = context or ControllerContext(name)
        loaded = LoadedController(name, type_name, find(CONTROLLERS, type_name), read_parameters, context)
        loaded.fallbacks = tuple(fallbacks)
        self.controllers[name] = loaded
        return loaded

    def configure(self, name: str) -> None:
        """Read a controller's parameters and create it; an inactive one is recreated.

        Raises
        ------
        UnknownError, StateError
        ParameterError
            When its parameters are wrong; it is then unconfigured.
        """
        loaded = _find(self.controllers, "controller", name)
        if loaded.state not in (UNCONFIGURED, INACTIVE):
            raise StateError(f"controller '{name}' is {loaded.state} and cannot be configured")
        self._forget(loaded)
        rate = loaded.context.update_rate
        if rate > self.update_rate:
            self._log(f"controller '{name}' wants {rate:g} Hz and gets the manager's {self.update_rate:g} Hz")
        rate = rate if 0 < rate < self.update_rate else self.update_rate
        context = replace(loaded.context, update_rate=rate, state_names=self.state_names)
        controller = loaded.kind(loaded.read_parameters(loaded.kind.Parameters), context)
        loaded.references = prefixed(name, controller.references)
        loaded.exported = prefixed(name, controller.exported)
        loaded.gate = RateGate(rate) if rate < self.update_rate else None
        loaded.controller, loaded.state = controller, INACTIVE

    def cleanup(self, name: str) -> None:
        """Return a controller to the state unconfigured.

        Raises
        ------
        UnknownError, StateError
        """
        loaded = _find(self.controllers, "controller", name)
        if loaded.state == ACTIVE:
            raise StateError(f"controller '{name}' is active; stop it first")
        self._forget(loaded)

    def unload(self, name: str) -> None:
        """Remove a controller; see `cleanup`."""
        self.cleanup(name)
        del self.controllers[name]

    def unload_all(self, force: bool = False) -> None:
        """Remove all controllers.

        Raises
        ------
        StateError
            When some are active, unless they are forced to stop.
        """
        active = [one.name for one in self._switcher.active]
        if active and not force:
            raise StateError(f"controllers are active: {', '.join(active)}")
        self._switcher.stop(active, self.time_ns)
        for name in list(self.controllers):
            self.unload(name)

    def switch(
        self,
        start: Sequence[str] = (),
        stop: Sequence[str] = (),
        strictness: Strictness = Strictness.STRICT,
    ) -> Switch:
        """Start and stop controllers, between two cycles.

        Returns
        -------
        Switch
            What was done, and what was left out and why.

        Raises
        ------
        SwitchError
            When it cannot be done; nothing has changed then.
        """
        return self._switcher.switch(start, stop, strictness, self.time_ns)

    def chained_to(self, name: str) -> dict[str, tuple[str, ...]]:
        """Return the references that a controller commands, by the name of their controller."""
        controller = _find(self.controllers, "controller", name).controller
        commands = controller.command_names if controller is not None else ()
        found = {
            other.name: tuple(one for one in commands if one in other.references) for other in self.controllers.values()
        }
        return {other: names for other, names in found.items() if names}

    # The loop

    def update(self, now_ns: int) -> list[tuple[str, Sample]]:
        """Read the hardware, update all controllers that are due, and write.

        Parameters
        ----------
        now_ns : int
            [ns]. When time went back, active controllers start anew.

        Returns
        -------
        list of (str, Sample)
            What there is to publish, with the controller's name.
        """
        nominal = 1.0 / self.update_rate
        went_back = now_ns < self.time_ns
        period = (now_ns - self.time_ns) * 1e-9 if self._started and now_ns > self.time_ns else nominal
        self._started, self.time_ns = True, now_ns
        for component in self.components.values():
            self._guard(component, component.read, now_ns, period)
        if went_back:
            self._switcher.restart(now_ns)
        said: list[tuple[str, Sample]] = []
        for loaded in self._switcher.order:
            if loaded.state == ACTIVE and (loaded.gate is None or loaded.gate.is_due(now_ns)):
                said += self._update_one(loaded, now_ns, nominal)
        for component in self.components.values():
            self._guard(component, component.write, now_ns, period)
        return said

    def shutdown(self) -> None:
        """Stop all controllers and hardware."""
        self.unload_all(force=True)
        for component in self.components.values():
            component.go_to(FINALIZED)

    # Inside

    def _update_one(self, loaded: LoadedController, now_ns: int, nominal: float) -> list[tuple[str, Sample]]:
        controller = loaded.running
        since = loaded.updated_ns
        rate = controller.context.update_rate if loaded.gate is not None else 1.0 / nominal
        period = (now_ns - since) * 1e-9 if 0 <= since < now_ns else 1.0 / rate
        loaded.updated_ns = controller.now_ns = now_ns
        try:
            if not controller.chained:
                controller.take_references(now_ns, period)
            return [(loaded.name, sample) for sample in controller.update(now_ns, period)]
        except Exception as error:  # a controller of the user's may raise anything; the others go on
            if not isinstance(error, ControlError):
                self._log(traceback.format_exc())
            self._fail(loaded, f"controller '{loaded.name}' failed and is stopped: {error}")
            return []

    def _fail(self, loaded: LoadedController, reason: str) -> None:
        self._log(reason)
        self._switcher.stop(self._switcher.with_dependents(loaded.name), self.time_ns)
        if loaded.fallbacks:
            try:
                self.switch(start=loaded.fallbacks)
            except SwitchError as error:
                self._log(f"the fallback controllers of '{loaded.name}' cannot be started: {error}")

    def _guard(self, component: Component, work: Callable[[int, float], None], now_ns: int, period: float) -> None:
        try:
            work(now_ns, period)
        except Exception as error:  # a driver of the user's may raise anything; the rest goes on
            if not isinstance(error, ControlError):
                self._log(traceback.format_exc())
            reason = f"hardware '{component.name}' failed: {error}"
            self._log(reason)
            component.state = UNCONFIGURED
            self._switcher.stop_users(component, (), reason, now_ns)

    def _forget(self, loaded: LoadedController) -> None:
        loaded.state, loaded.controller = UNCONFIGURED, None
        loaded.references, loaded.exported = Interfaces(), Interfaces()


def _find(known: Mapping[str, T], what: str, name: str) -> T:
    if name not in known:
        raise UnknownError(what, name, known)
    return known[name]
