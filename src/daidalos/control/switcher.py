"""Switching of controllers, with the hardware and the controllers that they need."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence

from daidalos.control.component import ACTIVE, INACTIVE, Component
from daidalos.control.errors import ControlError, HardwareError, SwitchError, UnknownError
from daidalos.control.interfaces import LoanedInterfaces
from daidalos.control.loaded_controller import LoadedController
from daidalos.control.switching import Candidate, Strictness, Switch, plan_switch, update_order


class Switcher:
    """Switcher of controllers between two cycles.

    Parameters
    ----------
    components : mapping of Component
    controllers : mapping of LoadedController
        Both are the manager's, and may change.
    log : callable
        Takes a line for the user.

    Attributes
    ----------
    order : tuple of LoadedController
        In which they are updated: whoever commands another comes first.
    """

    def __init__(
        self,
        components: Mapping[str, Component],
        controllers: Mapping[str, LoadedController],
        log: Callable[[str], None],
    ) -> None:
        self.order: tuple[LoadedController, ...] = ()
        self._components = components
        self._controllers = controllers
        self._log = log

    @property
    def active(self) -> list[LoadedController]:
        """Active controllers."""
        return [one for one in self._controllers.values() if one.state == ACTIVE]

    def switch(self, start: Sequence[str], stop: Sequence[str], strictness: Strictness, now_ns: int) -> Switch:
        """Plan and perform a switch; see `ControllerManager.switch`."""
        available = [
            name for one in self._components.values() if one.tells_states for name in one.hardware.states.names
        ]
        for name in start:
            loaded = self._controllers.get(name)
            if loaded is not None and loaded.controller is not None and loaded.state == INACTIVE:
                loaded.controller.select_states(available)
        plan = plan_switch(self._candidates(), start, stop, strictness, self._problem_with)
        self._carry_out(plan, now_ns)
        return plan

    def stop(self, names: Iterable[str], now_ns: int) -> None:
        """Stop controllers, in this order, including those that others need."""
        self._carry_out(Switch(stop=tuple(names), start=()), now_ns)

    def stop_users(self, component: Component, kept: Sequence[str], reason: str, now_ns: int) -> None:
        """Stop the controllers that use interfaces of hardware which it does not keep."""
        lost = {kind: () if kind in kept else component.interfaces(kind).names for kind in ("command", "state")}
        users = [
            one.name
            for one in self.active
            if set(lost["command"]) & set(one.running.command_names)
            or set(lost["state"]) & set(one.running.state_names)
        ]
        stop = [name for user in users for name in self.with_dependents(user)]
        if stop:
            self._log(f"{reason}; stopped are {', '.join(dict.fromkeys(stop))}")
            self.stop(dict.fromkeys(stop), now_ns)

    def with_dependents(self, name: str) -> tuple[str, ...]:
        """Return a controller after all active ones that need it."""
        stop = [name]
        for one in stop:  # grows on the way
            offers = {*self._controllers[one].references.names, *self._controllers[one].exported.names}
            stop += [
                other.name
                for other in self.active
                if other.name not in stop and offers & {*other.running.command_names, *other.running.state_names}
            ]
        return tuple(reversed(stop))

    def restart(self, now_ns: int) -> None:
        """Deactivate and activate the active controllers again after time went back."""
        self._release(name for one in self.active for name in one.running.command_names)
        for loaded in reversed(self.order):
            if loaded.state == ACTIVE:
                loaded.running.deactivate()
                self._start_one(loaded, now_ns)

    def _carry_out(self, plan: Switch, now_ns: int) -> None:
        released = [name for one in plan.stop for name in self._controllers[one].running.command_names]
        wanted = [name for one in plan.start for name in self._controllers[one].running.command_names]
        if wanted:  # stopping is never refused
            self._switch_hardware(wanted, released, commit=False)
        for name in plan.stop:
            self._stop_one(self._controllers[name])
        self._release(set(released) - set(wanted))
        self._switch_hardware(wanted, released, commit=True)
        started: list[str] = []
        try:
            for name in plan.start:
                self._start_one(self._controllers[name], now_ns)
                started.append(name)
        except ControlError as error:
            for name in reversed(started):
                self._stop_one(self._controllers[name])
            raise SwitchError(str(error)) from error
        finally:
            self._settle()

    def _switch_hardware(self, start: Sequence[str], stop: Sequence[str], commit: bool) -> None:
        for component in self._components.values():
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

    def _start_one(self, loaded: LoadedController, now_ns: int) -> None:
        controller = loaded.running
        commands = [one.hardware.commands for one in self._components.values()]
        states = [one.hardware.states for one in self._components.values()]
        commands += [other.references for other in self._controllers.values() if other is not loaded]
        states += [other.exported for other in self._controllers.values() if other is not loaded]
        controller.assign(
            LoanedInterfaces(controller.command_names, commands), LoanedInterfaces(controller.state_names, states)
        )
        loaded.updated_ns = -1
        if loaded.gate is not None:
            loaded.gate.restart()
        controller.now_ns = now_ns
        controller.activate(now_ns)
        loaded.state = ACTIVE

    def _stop_one(self, loaded: LoadedController) -> None:
        loaded.state = INACTIVE
        loaded.running.deactivate()

    def _release(self, names: Iterable[str]) -> None:
        """Set commands that no controller writes to NaN."""
        for name in names:
            for component in self._components.values():
                if name in component.hardware.commands:
                    component.hardware.commands[name] = float("nan")

    def _settle(self) -> None:
        """Update the order of controllers and their chains after a switch."""
        self.order = tuple(self._controllers[name] for name in update_order(self._candidates()))
        commanded = {name for one in self.active for name in one.running.command_names}
        for loaded in self._controllers.values():
            if loaded.controller is None:
                continue
            chained = bool(commanded & set(loaded.references.names))
            if chained != loaded.controller.chained:
                loaded.controller.chained = chained
                loaded.references.values[:] = float("nan")

    def _candidates(self) -> dict[str, Candidate]:
        return {name: one.candidate for name, one in self._controllers.items()}

    def _problem_with(self, kind: str, interface: str) -> str:
        for component in self._components.values():
            if interface in component.interfaces(kind):
                available = component.takes_commands if kind == "command" else component.tells_states
                return "" if available else f"hardware '{component.name}' is {component.state}"
        owner = next(
            (
                one.name
                for one in self._controllers.values()
                if interface in (*one.references.names, *one.exported.names)
            ),
            "",
        )
        if owner:
            return f"controller '{owner}' is not active"
        known = [name for one in self._components.values() for name in one.interfaces(kind).names]
        return str(UnknownError(f"{kind} interface", interface, known))
