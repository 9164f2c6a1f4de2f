"""Interrupts: timers and signals that run traps between instructions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from daidalos.industry.rapid.runtime.errors import RapidError
from daidalos.industry.rapid.runtime.registry import routine
from daidalos.industry.rapid.runtime.values import copied

if TYPE_CHECKING:
    from daidalos.industry.rapid.runtime.task import Task


@dataclass
class Interrupt:
    """A trap, and what it waits for."""

    trap: Callable[[], Any]
    signal: str = ""
    edge: float | None = None
    due: float | None = None
    period: float | None = None
    is_single: bool = False
    is_asleep: bool = False
    condition: Callable[[float], bool] | None = None
    """Of a signal's value; without it, each change counts."""
    watched: tuple[Any, Any] | None = None
    """Reference of a persistent."""
    seen: Any = None


class Interrupts:
    """The interrupts of a task by their numbers."""

    def __init__(self, task: Task) -> None:
        self._task = task
        self._by_number: dict[float, Interrupt] = {}
        self._queue: list[float] = []
        self.is_serving = False
        """Whether a trap runs."""
        self.is_enabled = True
        task.signals.listeners.append(self._on_signal)

    def close(self) -> None:
        """Take no more signals."""
        self._task.signals.listeners.remove(self._on_signal)

    def connect(self, trap: Callable[[], Any]) -> float:
        """Return the number of a new interrupt."""
        number = float(max(self._by_number, default=0.0) + 1)
        self._by_number[number] = Interrupt(trap)
        return number

    def find(self, reference: tuple[Any, Any]) -> Interrupt:
        """Return the interrupt whose number a variable holds.

        Raises
        ------
        RapidError
            ERR_UNKINO
        """
        number = reference[0][reference[1]]
        if number not in self._by_number:
            raise RapidError("ERR_UNKINO", "the interrupt is not connected to a trap; CONNECT comes first")
        return self._by_number[number]

    def delete(self, reference: tuple[Any, Any]) -> None:
        """Disconnect an interrupt."""
        self._by_number.pop(reference[0][reference[1]], None)

    def next_time(self) -> float | None:
        """Return when the next timer is due; None where there is none."""
        times = [one.due for one in self._by_number.values() if one.due is not None]
        return min(times, default=None)

    def serve(self) -> None:
        """Run the traps of all interrupts that have occurred, in their order; one trap does not interrupt another."""
        for number, one in self._by_number.items():
            if one.due is not None and one.due <= self._task.time:
                one.due = one.due + one.period if one.period and not one.is_single else None
                self._occur(number, one)
        for number, one in self._by_number.items():
            if one.watched is not None and (present := one.watched[0][one.watched[1]]) != one.seen:
                one.seen = copied(present)
                self._occur(number, one)
        if self.is_serving or not self.is_enabled:
            return
        self.is_serving = True
        try:
            while self._queue:
                number = self._queue.pop(0)
                if number in self._by_number:
                    self._task.intno = number
                    self._by_number[number].trap()
        finally:
            self.is_serving = False

    def _on_signal(self, key: str, value: float) -> None:
        for number, one in list(self._by_number.items()):
            if one.signal == key and (one.edge is None or one.edge == 2.0 or one.edge == value):
                if one.condition is not None and not one.condition(value):
                    continue
                if one.is_single:
                    one.signal = ""
                self._occur(number, one)

    def occur(self, number: float) -> None:
        """Trigger an interrupt, unless it was disconnected meanwhile."""
        if number in self._by_number:
            self._occur(number, self._by_number[number])

    def _occur(self, number: float, one: Interrupt) -> None:
        if not one.is_asleep:
            self._queue.append(number)
            if self._task.cell is not None:
                self._task.cell.wake(self._task)


@routine("ITimer")
def i_timer(task: Task, time_: float, interrupt_: Any, single_: Any = None, singlesafe_: Any = None) -> None:
    """Order a timer, once or again and again."""
    one = task.interrupts.find(interrupt_)
    one.period, one.due, one.is_single = time_, task.time + time_, bool(single_ or singlesafe_)


@routine("ISignalDI", "ISignalDO")
def i_signal(
    task: Task, signal_: str, triggvalue_: float, interrupt_: Any, single_: Any = None, singlesafe_: Any = None
) -> None:
    """Order an interrupt by a digital signal."""
    one = task.interrupts.find(interrupt_)
    one.signal, one.edge, one.is_single = str(signal_).lower(), triggvalue_, bool(single_ or singlesafe_)


@routine("ISignalGI", "ISignalGO")
def i_group(task: Task, signal_: str, interrupt_: Any, single_: Any = None, singlesafe_: Any = None) -> None:
    """Order an interrupt by a change of a group of signals."""
    one = task.interrupts.find(interrupt_)
    one.signal, one.edge, one.is_single = str(signal_).lower(), None, bool(single_ or singlesafe_)


@routine("ISignalAI", "ISignalAO")
def i_analog(
    task: Task,
    signal_: str,
    condition_: float,
    highvalue_: float,
    lowvalue_: float,
    deltavalue_: float,
    interrupt_: Any,
    single_: Any = None,
    singlesafe_: Any = None,
    dpos_: Any = None,
    dneg_: Any = None,
) -> None:
    """Order an interrupt by an analog signal: where a condition holds, and it has changed by more than a difference."""
    reference = [task.signals.value(signal_)]

    def holds(value: float) -> bool:
        change = value - reference[0]
        fits = _ANALOG[condition_](value, highvalue_, lowvalue_)
        is_large = abs(change) > deltavalue_ and not (dpos_ and change < 0) and not (dneg_ and change > 0)
        if fits and is_large:
            reference[0] = value
        return fits and is_large

    if condition_ not in _ANALOG:
        raise RapidError("ERR_ARGVALERR", f"the condition is AIO_ABOVE_HIGH to AIO_ALWAYS, not {condition_:g}")
    one = task.interrupts.find(interrupt_)
    one.signal, one.edge, one.is_single = str(signal_).lower(), None, bool(single_ or singlesafe_)
    one.condition = holds


_ANALOG: dict[float, Callable[[float, float, float], bool]] = {
    1.0: lambda value, high, low: value > high,
    2.0: lambda value, high, low: value < high,
    3.0: lambda value, high, low: value > low,
    4.0: lambda value, high, low: value < low,
    5.0: lambda value, high, low: low < value < high,
    6.0: lambda value, high, low: value < low or value > high,
    7.0: lambda value, high, low: True,
}
"""Conditions by AIO_ABOVE_HIGH and so on."""


@routine("IPers")
def i_persistent(task: Task, name_: Any, interrupt_: Any) -> None:
    """Order an interrupt by a change of a persistent."""
    one = task.interrupts.find(interrupt_)
    one.watched = name_ if isinstance(name_, tuple) else ([name_], 0)
    one.seen = copied(one.watched[0][one.watched[1]])


@routine("ISleep")
def i_sleep(task: Task, interrupt_: Any) -> None:
    """Suspend an interrupt."""
    task.interrupts.find(interrupt_).is_asleep = True


@routine("IWatch")
def i_watch(task: Task, interrupt_: Any) -> None:
    """Resume an interrupt."""
    task.interrupts.find(interrupt_).is_asleep = False


@routine("IDelete")
def i_delete(task: Task, interrupt_: Any) -> None:
    """Disconnect an interrupt."""
    task.interrupts.delete(interrupt_)


@routine("IDisable")
def i_disable(task: Task) -> None:
    """Hold all interrupts back."""
    task.interrupts.is_enabled = False


@routine("IEnable")
def i_enable(task: Task) -> None:
    """Serve interrupts again, and those that were held back."""
    task.interrupts.is_enabled = True
    task.interrupts.serve()
