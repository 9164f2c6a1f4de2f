"""Predefined routines that act at a place of a movement: TriggIO, TriggEquip, TriggInt, TriggL, TriggJ and TriggC."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from daidalos.industry.rapid.runtime.errors import RapidError
from daidalos.industry.rapid.runtime.movements import order
from daidalos.industry.rapid.runtime.registry import routine
from daidalos.industry.rapid.runtime.robot import Event

if TYPE_CHECKING:
    from daidalos.industry.rapid.runtime.task import Task
    from daidalos.industry.rapid.runtime.values import Handle


def _setting(task: Task, outputs: tuple[Any, ...], value: float, inhibit: Any) -> Callable[[], None]:
    """Return what sets the output of a trigger."""
    signal = next((one for one in outputs if one is not None), None)
    if signal is None:
        raise RapidError("ERR_ARGVALERR", "a trigger needs an output: \\DOp, \\GOp or \\AOp")
    task.signals.value(signal)

    def act() -> None:
        if not _is_inhibited(inhibit):
            task.signals.set(signal, float(value))

    return act


def _is_inhibited(inhibit: Any) -> bool:
    return bool(inhibit[0][inhibit[1]]) if isinstance(inhibit, tuple | list) else bool(inhibit)


def _event(action: Callable[[], None], distance: float, start: Any, time: Any, lag: float = 0.0) -> Event:
    if distance < 0:
        raise RapidError("ERR_ARGVALERR", f"the distance of a trigger is 0 or more, not {distance:g}")
    if time:
        return Event(action, 0.0, False, distance + lag)
    return Event(action, distance, bool(start), lag)


@routine("TriggIO")
def trigg_io(
    task: Task,
    triggdata_: Handle,
    distance_: float,
    setvalue_: float,
    start_: Any = None,
    time_: Any = None,
    dop_: Any = None,
    gop_: Any = None,
    aop_: Any = None,
    dodelay_: float | None = None,
    inhib_: Any = None,
    **rest: Any,
) -> None:
    """Define an output that is set at a place."""
    action = _setting(task, (dop_, gop_, aop_), setvalue_, inhib_)
    triggdata_.state = _event(action, distance_, start_, time_, -(dodelay_ or 0.0))


@routine("TriggEquip")
def trigg_equip(
    task: Task,
    triggdata_: Handle,
    distance_: float,
    equiplag_: float,
    setvalue_: float,
    start_: Any = None,
    dop_: Any = None,
    gop_: Any = None,
    aop_: Any = None,
    inhib_: Any = None,
    **rest: Any,
) -> None:
    """Define an output that is set at a place, earlier by the time that the equipment takes."""
    action = _setting(task, (dop_, gop_, aop_), setvalue_, inhib_)
    triggdata_.state = _event(action, distance_, start_, None, equiplag_)


@routine("TriggInt")
def trigg_int(
    task: Task,
    triggdata_: Handle,
    distance_: float,
    interrupt_: Any,
    start_: Any = None,
    time_: Any = None,
    inhib_: Any = None,
    **rest: Any,
) -> None:
    """Define an interrupt at a place."""
    task.interrupts.find(interrupt_)
    number = interrupt_[0][interrupt_[1]]

    def act() -> None:
        if not _is_inhibited(inhib_):
            task.interrupts.occur(number)

    triggdata_.state = _event(act, distance_, start_, time_)


@routine("TriggDataReset")
def trigg_data_reset(task: Task, triggdata_: Handle) -> None:
    """Forget what a trigger does."""
    triggdata_.state = None


@routine("TriggDataCopy")
def trigg_data_copy(task: Task, source_: Handle, destination_: Handle) -> None:
    """Copy what a trigger does."""
    destination_.state = source_.state


@routine("TriggDataValid")
def trigg_data_valid(task: Task, triggdata_: Handle) -> bool:
    """Return whether it was said what a trigger does."""
    return triggdata_.state is not None


def _events(triggers: tuple[Any, ...]) -> tuple[Event, ...]:
    given = [one for one in triggers if one is not None]
    if any(one.state is None for one in given):
        raise RapidError("ERR_ARGVALERR", "a trigger is not defined; TriggIO, TriggEquip or TriggInt comes first")
    return tuple(one.state for one in given)


def _trigger_routine(name: str, instruction: str) -> None:
    @routine(name)
    def move(
        task: Task,
        topoint_: list[Any],
        speed_: list[float],
        trigg_1_: Any,
        zone_: list[Any],
        tool_: list[Any],
        cirpoint_: list[Any] | None = None,
        t2_: Any = None,
        t3_: Any = None,
        t4_: Any = None,
        t5_: Any = None,
        t6_: Any = None,
        t7_: Any = None,
        t8_: Any = None,
        wobj_: list[Any] | None = None,
        t_: float | None = None,
        **rest: Any,
    ) -> None:
        events = _events((trigg_1_, t2_, t3_, t4_, t5_, t6_, t7_, t8_))
        order(task, instruction, topoint_, speed_, zone_, tool_, wobj_, cirpoint_, None, t_, None, events)


for _name, _instruction in (("TriggL", "MoveL"), ("TriggJ", "MoveJ"), ("TriggC", "MoveC")):
    _trigger_routine(_name, _instruction)
