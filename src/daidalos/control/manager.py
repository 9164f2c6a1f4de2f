"""The controller manager: hardware, controllers, who holds what, and the loop that runs them all."""

from __future__ import annotations

import logging
import traceback
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import TypeVar

from daidalos.control.component import ACTIVE, FINALIZED, INACTIVE, UNCONFIGURED, Component
from daidalos.control.controllers.base import ControllerSetting
from daidalos.control.errors import ControlError, HardwareError, StateError, SwitchError, UnknownError
from daidalos.control.hardware.base import Hardware
from daidalos.control.interfaces import Interfaces, Loan
from daidalos.control.loaded_controller import LoadedController, Reader, prefixed
from daidalos.control.plugins import controller_class
from daidalos.control.pulse import Pulse
from daidalos.control.switching import Candidate, Strictness, Switch, plan_switch, update_order
from daidalos.simulation.samples import Sample

_log = logging.getLogger(__name__)
T = TypeVar("T")


class ControllerManager:
    """Runs controllers on hardware.

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
        self._order: tuple[LoadedController, ...] = ()
        self._started = False
        for one in hardware:
            self._add(Component(one, enforce_limits), (initial_states or {}).get(one.info.name, ACTIVE))

    def _add(self, component: Component, state: str) -> None:
        for kind in ("command", "state"):
            taken = {name: one.name for one in self.components.values() for name in _interfaces(one, kind).names}
            for name in _interfaces(component, kind).names:
                if name in taken:
                    raise ControlError(f"hardware '{component.name}' and '{taken[name]}' both have {kind} {name}")
        self.components[component.name] = component
        try:
            component.go_to(state)
        except HardwareError as error:
            self._log(f"hardware '{component.name}' can not be made {state}: {error}")

    # Hardware

    @property
    def state_names(self) -> tuple[str, ...]:
        """All state interfaces of the hardware."""
        return tuple(name for one in self.components.values() for name in one.hardware.states.names)

    def set_component_state(self, name: str, target: str) -> None:
        """Bring hardware to a state; controllers that can not run without it are stopped.

        Raises
        ------
        UnknownError, StateError, HardwareError
        """
        component = _find(self.components, "hardware", name)
        kept = {ACTIVE: ("command", "state"), INACTIVE: ("state",)}.get(target, ())
        self._stop_users(component, kept, f"hardware '{name}' becomes {target}")
        component.go_to(target)

    def claimed(self, interface: str) -> str:
        """Return which active controller holds a command interface, nothing where none does."""
        return next((one.name for one in self._active() if interface in one.running.command_names), "")

    # Controllers

    def load(
        self,
        name: str,
        type_name: str,
        read_parameters: Reader,
        setting: ControllerSetting | None = None,
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
        setting : ControllerSetting or None
            Its rate is brought down to the manager's; 0 is the manager's.
        fallbacks : sequence of str

        Raises
        ------
        StateError
            When there is one of that name.
        UnknownError
            When there is no such type.
        """
        if name in self.controllers:
            raise StateError(f"a controller '{name}' is loaded already")
        setting = setting or ControllerSetting(name)
        loaded = LoadedController(name, type_name, controller_class(type_name), read_parameters, setting)
        loaded.fallbacks = tuple(fallbacks)
        self.controllers[name] = loaded
        return loaded

    def configure(self, name: str) -> None:
        """Read a controller's parameters and make it; an inactive one is made anew.

        Raises
        ------
        UnknownError, StateError
        ParameterError
            When its parameters are wrong; it is then unconfigured.
        """
        loaded = _find(self.controllers, "controller", name)
        if loaded.state not in (UNCONFIGURED, INACTIVE):
            raise StateError(f"controller '{name}' is {loaded.state} and can not be configured")
        self._forget(loaded)
        rate = loaded.setting.update_rate
        if rate > self.update_rate:
            self._log(f"controller '{name}' wants {rate:g} Hz and gets the manager's {self.update_rate:g} Hz")
        rate = rate if 0 < rate < self.update_rate else self.update_rate
        setting = replace(loaded.setting, update_rate=rate, state_names=self.state_names)
        controller = loaded.kind(loaded.read_parameters(loaded.kind.parameters), setting)
        loaded.references = prefixed(name, controller.references)
        loaded.exported = prefixed(name, controller.exported)
        loaded.pulse = Pulse(rate) if rate < self.update_rate else None
        loaded.controller, loaded.state = controller, INACTIVE

    def cleanup(self, name: str) -> None:
        """Take a controller back to unconfigured.

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
        active = [one.name for one in self._active()]
        if active and not force:
            raise StateError(f"controllers are active: {', '.join(active)}")
        self._carry_out(Switch(stop=tuple(active), start=()))
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
            When it can not be done; nothing has changed then.
        """
        plan = plan_switch(self._candidates(), start, stop, strictness, self._problem_with)
        self._carry_out(plan)
        return plan

    def chained_to(self, name: str) -> dict[str, tuple[str, ...]]:
        """Return whom a controller commands: references by the name of their controller."""
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
            self._restart()
        said: list[tuple[str, Sample]] = []
        for loaded in self._order:
            if loaded.state == ACTIVE and (loaded.pulse is None or loaded.pulse.due(now_ns)):
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
        rate = controller.setting.update_rate if loaded.pulse is not None else 1.0 / nominal
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
        self._carry_out(Switch(stop=self._with_those_above(loaded.name), start=()))
        if loaded.fallbacks:
            try:
                self.switch(start=loaded.fallbacks)
            except SwitchError as error:
                self._log(f"the fallback controllers of '{loaded.name}' can not be started: {error}")

    def _guard(self, component: Component, work: Callable[[int, float], None], now_ns: int, period: float) -> None:
        try:
            work(now_ns, period)
        except Exception as error:  # a driver of the user's may raise anything; the rest goes on
            if not isinstance(error, ControlError):
                self._log(traceback.format_exc())
            reason = f"hardware '{component.name}' failed: {error}"
            self._log(reason)
            component.state = UNCONFIGURED
            self._stop_users(component, (), reason)

    def _stop_users(self, component: Component, kept: Sequence[str], reason: str) -> None:
        """Stop the controllers that use interfaces of hardware which it does not keep."""
        lost = {kind: () if kind in kept else _interfaces(component, kind).names for kind in ("command", "state")}
        users = [
            one.name
            for one in self._active()
            if set(lost["command"]) & set(one.running.command_names)
            or set(lost["state"]) & set(one.running.state_names)
        ]
        stop = [name for user in users for name in self._with_those_above(user)]
        if stop:
            self._log(f"{reason}; stopped are {', '.join(dict.fromkeys(stop))}")
            self._carry_out(Switch(stop=tuple(dict.fromkeys(stop)), start=()))

    def _with_those_above(self, name: str) -> tuple[str, ...]:
        """Return a controller after all active ones that need it."""
        stop = [name]
        for one in stop:  # grows on the way
            offers = {*self.controllers[one].references.names, *self.controllers[one].exported.names}
            stop += [
                other.name
                for other in self._active()
                if other.name not in stop and offers & {*other.running.command_names, *other.running.state_names}
            ]
        return tuple(reversed(stop))

    def _carry_out(self, plan: Switch) -> None:
        released = [name for one in plan.stop for name in self.controllers[one].running.command_names]
        wanted = [name for one in plan.start for name in self.controllers[one].running.command_names]
        if wanted:  # stopping is never refused
            self._switch_hardware(wanted, released, commit=False)
        for name in plan.stop:
            self._stop_one(self.controllers[name])
        self._release(set(released) - set(wanted))
        self._switch_hardware(wanted, released, commit=True)
        started: list[str] = []
        try:
            for name in plan.start:
                self._start_one(self.controllers[name])
                started.append(name)
        except ControlError as error:
            for name in reversed(started):
                self._stop_one(self.controllers[name])
            raise SwitchError(str(error)) from error
        finally:
            self._settle()

    def _switch_hardware(self, start: Sequence[str], stop: Sequence[str], commit: bool) -> None:
        for component in self.components.values():
            own = component.hardware.commands
            mine = [[name for name in names if name in own] for names in (start, stop)]
            if not any(mine):
                continue
            try:
                (component.hardware.switch if commit else component.hardware.prepare_switch)(*mine)
            except HardwareError as error:
                if not commit:
                    raise SwitchError(f"hardware '{component.name}' refuses: {error}") from error
                self._log(f"hardware '{component.name}' did not switch: {error}")

    def _start_one(self, loaded: LoadedController) -> None:
        controller = loaded.running
        commands = [one.hardware.commands for one in self.components.values()]
        states = [one.hardware.states for one in self.components.values()]
        commands += [other.references for other in self.controllers.values() if other is not loaded]
        states += [other.exported for other in self.controllers.values() if other is not loaded]
        controller.assign(Loan(controller.command_names, commands), Loan(controller.state_names, states))
        loaded.updated_ns = -1
        if loaded.pulse is not None:
            loaded.pulse.restart()
        controller.now_ns = self.time_ns
        controller.activate(self.time_ns)
        loaded.state = ACTIVE

    def _stop_one(self, loaded: LoadedController) -> None:
        loaded.state = INACTIVE
        loaded.running.deactivate()

    def _release(self, names: Iterable[str]) -> None:
        """Let nobody's commands be none."""
        for name in names:
            for component in self.components.values():
                if name in component.hardware.commands:
                    component.hardware.commands[name] = float("nan")

    def _settle(self) -> None:
        """After a switch: find the order and who is commanded by whom."""
        self._order = tuple(self.controllers[name] for name in update_order(self._candidates()))
        commanded = {name for one in self._active() for name in one.running.command_names}
        for loaded in self.controllers.values():
            if loaded.controller is None:
                continue
            chained = bool(commanded & set(loaded.references.names))
            if chained != loaded.controller.chained:
                loaded.controller.chained = chained
                loaded.references.values[:] = float("nan")

    def _restart(self) -> None:
        """Let active controllers forget what was before time went back."""
        self._release(name for one in self._active() for name in one.running.command_names)
        for loaded in reversed(self._order):
            if loaded.state == ACTIVE:
                loaded.running.deactivate()
                self._start_one(loaded)

    def _forget(self, loaded: LoadedController) -> None:
        loaded.state, loaded.controller = UNCONFIGURED, None
        loaded.references, loaded.exported = Interfaces(), Interfaces()

    def _active(self) -> list[LoadedController]:
        return [one for one in self.controllers.values() if one.state == ACTIVE]

    def _candidates(self) -> dict[str, Candidate]:
        return {name: one.candidate for name, one in self.controllers.items()}

    def _problem_with(self, kind: str, interface: str) -> str:
        for component in self.components.values():
            if interface in _interfaces(component, kind):
                available = component.takes_commands if kind == "command" else component.tells_states
                return "" if available else f"hardware '{component.name}' is {component.state}"
        owner = next(
            (
                one.name
                for one in self.controllers.values()
                if interface in (*one.references.names, *one.exported.names)
            ),
            "",
        )
        if owner:
            return f"controller '{owner}' is not active"
        known = [name for one in self.components.values() for name in _interfaces(one, kind).names]
        return str(UnknownError(f"{kind} interface", interface, known))


def _interfaces(component: Component, kind: str) -> Interfaces:
    return component.hardware.commands if kind == "command" else component.hardware.states


def _find(known: Mapping[str, T], what: str, name: str) -> T:
    if name not in known:
        raise UnknownError(what, name, known)
    return known[name]
