"""Planning of controller switches: interfaces are claimed once, chains stay complete."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum

from daidalos.control.errors import SwitchError


class Strictness(IntEnum):
    """Handling of controllers that cannot be switched.

    ``BEST_EFFORT`` leaves them out; ``STRICT`` switches all or none; ``AUTO`` starts controllers as well that are
    needed; ``FORCE_AUTO`` also stops those that are in the way.
    """

    BEST_EFFORT = 1
    STRICT = 2
    AUTO = 3
    FORCE_AUTO = 4


@dataclass(frozen=True)
class Candidate:
    """State of a controller that is relevant to a switch.

    Parameters
    ----------
    state : str
    commands, states : tuple of str
        Interfaces that it needs.
    references, exported : tuple of str
        Interfaces that it offers, full names.
    """

    state: str
    commands: tuple[str, ...] = ()
    states: tuple[str, ...] = ()
    references: tuple[str, ...] = ()
    exported: tuple[str, ...] = ()


@dataclass(frozen=True)
class Switch:
    """Planned switch.

    Parameters
    ----------
    stop, start : tuple of str
        In the order in which it should happen: whoever commands another stops first and starts last.
    left_out : tuple of str
        Why controllers were left out.
    """

    stop: tuple[str, ...]
    start: tuple[str, ...]
    left_out: tuple[str, ...] = ()


def plan_switch(
    controllers: Mapping[str, Candidate],
    start: Sequence[str],
    stop: Sequence[str],
    strictness: Strictness,
    problem_with: Callable[[str, str], str],
) -> Switch:
    """Plan a switch of controllers.

    Parameters
    ----------
    controllers : mapping
        All that are loaded, by name.
    start, stop : sequence of str
    strictness : Strictness
    problem_with : callable
        Takes ``command`` or ``state`` and the name of an interface; returns why the hardware does not offer it,
        nothing when it does.

    Returns
    -------
    Switch

    Raises
    ------
    SwitchError
        When something cannot be switched and the strictness wants all of it.
    """
    return _Planner(controllers, start, stop, strictness, problem_with).run()


def update_order(controllers: Mapping[str, Candidate]) -> tuple[str, ...]:
    """Return the names sorted so that a controller comes before those it commands and after those it only reads."""
    owner = {name: key for key, one in controllers.items() for name in one.references}
    source = {name: key for key, one in controllers.items() for name in one.exported}
    before: dict[str, set[str]] = {key: set() for key in controllers}
    for key, one in controllers.items():
        for name in one.commands:
            if name in owner:
                before[owner[name]].add(key)
        commanded = {owner[name] for name in one.commands if name in owner}
        # Who reads a controller that it commands reads what that said one cycle before.
        before[key] |= {source[name] for name in one.states if name in source} - commanded - {key}
    ordered: list[str] = []
    while len(ordered) < len(controllers):
        ready = next((key for key in controllers if key not in ordered and before[key] <= set(ordered)), None)
        # In a loop of controllers somebody has to be first.
        ordered.append(ready or next(key for key in controllers if key not in ordered))
    return tuple(ordered)


class _Planner:
    def __init__(
        self,
        controllers: Mapping[str, Candidate],
        start: Sequence[str],
        stop: Sequence[str],
        strictness: Strictness,
        problem_with: Callable[[str, str], str],
    ) -> None:
        self._all = controllers
        self._start, self._stop = list(dict.fromkeys(start)), list(dict.fromkeys(stop))
        self._strictness = strictness
        self._problem_with = problem_with
        self._left_out: list[str] = []
        self._owner = {name: key for key, one in controllers.items() for name in one.references}

    def run(self) -> Switch:
        self._check_states()
        if self._strictness >= Strictness.AUTO:
            self._add_dependencies()
        while self._drop_one():
            pass
        if self._left_out and self._strictness != Strictness.BEST_EFFORT:
            raise SwitchError("; ".join(self._left_out))
        order = update_order(self._all)
        return Switch(
            stop=tuple(name for name in order if name in self._stop),
            start=tuple(name for name in reversed(order) if name in self._start),
            left_out=tuple(self._left_out),
        )

    def _check_states(self) -> None:
        for names, wanted, doing in ((self._stop, "active", "stopped"), (self._start, "inactive", "started")):
            for name in list(names):
                if name not in self._all:
                    self._leave_out(names, name, f"there is no controller '{name}'")
                    continue
                state = self._all[name].state
                restarts = names is self._start and state == "active" and name in self._stop
                if state != wanted and not restarts:
                    self._leave_out(names, name, f"controller '{name}' is {state} and cannot be {doing}")

    def _add_dependencies(self) -> None:
        """Add the controllers whose references are needed, and stop conflicting ones if requested."""
        for name in self._start:  # grows on the way
            for interface in self._all[name].commands:
                owner = self._owner.get(interface)
                if owner and owner not in self._start and self._all[owner].state == "inactive":
                    self._start.append(owner)
        if self._strictness != Strictness.FORCE_AUTO:
            return
        claimed = {interface for name in self._start for interface in self._all[name].commands}
        for name, one in self._all.items():
            running = one.state == "active" and name not in self._start and name not in self._stop
            if running and claimed & set(one.commands):
                self._stop.append(name)
        for name in self._stop:  # grows on the way
            self._stop += [
                other
                for other, one in self._all.items()
                if one.state == "active" and other not in self._stop and set(one.commands) & self._offers(name)
            ]

    def _drop_one(self) -> bool:
        """Remove the first change that is not possible; return whether there was one."""
        running = self._running()
        for name in running:
            problem = self._missing(name, running)
            if problem and name in self._start:
                self._leave_out(self._start, name, problem)
                return True
            stopped = self._stopped_below(name)
            if problem and stopped:
                reason = f"controller '{stopped}' is needed by '{name}' and cannot be stopped without it"
                self._leave_out(self._stop, stopped, reason)
                return True
        return self._drop_claimed_twice(running)

    def _drop_claimed_twice(self, running: Iterable[str]) -> bool:
        claimed: dict[str, str] = {}
        for name in running:
            for interface in self._all[name].commands:
                other = claimed.setdefault(interface, name)
                if other == name:
                    continue
                # Those that run already come first, so the later one is being started.
                self._leave_out(self._start, name, f"controller '{name}' needs {interface}, which '{other}' holds")
                return True
        return False

    def _running(self) -> list[str]:
        """Return the controllers that run afterwards: the continuing ones, then the started ones."""
        going_on = [n for n, one in self._all.items() if one.state == "active" and n not in self._stop]
        return [*(name for name in going_on if name not in self._start), *self._start]

    def _missing(self, name: str, running: Sequence[str]) -> str:
        """Return why a controller cannot run beside the others, or an empty string."""
        offered = {interface for other in running if other != name for interface in self._offers(other)}
        for kind, interfaces in (("command", self._all[name].commands), ("state", self._all[name].states)):
            for interface in interfaces:
                if interface in offered:
                    continue
                problem = self._problem_with(kind, interface)
                if problem:
                    return f"controller '{name}' needs {interface}: {problem}"
        return ""

    def _stopped_below(self, name: str) -> str:
        needed = set(self._all[name].commands) | set(self._all[name].states)
        return next((other for other in self._stop if needed & self._offers(other)), "")

    def _offers(self, name: str) -> set[str]:
        return set(self._all[name].references) | set(self._all[name].exported)

    def _leave_out(self, names: list[str], name: str, reason: str) -> None:
        names.remove(name)
        if names is self._stop and name in self._start:
            self._start.remove(name)
        self._left_out.append(reason)
