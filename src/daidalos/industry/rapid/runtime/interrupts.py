"""Interrupts: timers and signals that run traps between instructions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from daidalos.industry.rapid.runtime.errors import RapidError
from daidalos.industry.rapid.runtime.registry import routine

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
