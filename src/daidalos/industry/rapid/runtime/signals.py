"""Predefined routines on signals."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from daidalos.industry.rapid.runtime.errors import RapidError
from daidalos.industry.rapid.runtime.registry import routine
from daidalos.industry.rapid.runtime.timing import wait_for

if TYPE_CHECKING:
    from daidalos.industry.rapid.runtime.task import Task

PULSE = 0.2
"""Length of PulseDO's pulse in seconds, where the program does not say."""


def _set(task: Task, signal: str, value: float) -> None:
    task.signals.set(signal, value)
    task.pass_time(0.0)


@routine("SetDO")
def set_do(task: Task, signal_: str, value_: float, sync_: Any = None, sdelay_: float | None = None) -> None:
    """Set a digital output; with a delay when that has passed, without the program waiting for it."""
    if value_ not in (0.0, 1.0):
        raise RapidError("ERR_ARGVALERR", f"a digital signal is 0 or 1, not {value_:g}")
    _set(task, signal_, value_)


@routine("SetGO", "SetAO")
def set_group(task: Task, signal_: str, value_: float, sdelay_: float | None = None) -> None:
    """Set a group of outputs, or an analog one."""
    _set(task, signal_, value_)


@routine("Set")
def set_high(task: Task, signal_: str) -> None:
    """Set a digital output to 1."""
    _set(task, signal_, 1.0)


@routine("Reset")
def set_low(task: Task, signal_: str) -> None:
    """Set a digital output to 0."""
    _set(task, signal_, 0.0)


@routine("InvertDO")
def invert(task: Task, signal_: str) -> None:
    """Invert a digital output."""
    _set(task, signal_, 1.0 - task.signals.value(signal_))


@routine("PulseDO")
def pulse(task: Task, signal_: str, high_: Any = None, plength_: float | None = None) -> None:
    """Invert a digital output, or set it to 1, and back when the pulse is over."""
    before = 0.0 if high_ else task.signals.value(signal_)
    task.signals.set(signal_, 1.0 if high_ else 1.0 - before)
    number = task.interrupts.connect(lambda: task.signals.set(signal_, before))
    one = task.interrupts.find(([number], 0))
    one.due, one.is_single = task.time + (PULSE if plength_ is None else plength_), True
    task.pass_time(0.0)


@routine(
    "DInput", "DOutput", "GInput", "GOutput", "GInputDnum", "GOutputDnum", "AInput", "AOutput"
)  # fmt: skip
def value(task: Task, signal_: str) -> float:
    """Return the value of a signal."""
    return task.signals.value(signal_)


@routine("TestDI")
def is_high(task: Task, signal_: str) -> bool:
    """Return whether a digital input is 1."""
    return task.signals.value(signal_) == 1.0


@routine("ValidIO")
def is_valid(task: Task, signal_: str) -> bool:
    """Return whether a signal can be used."""
    return True


@routine("AliasIO")
def alias(task: Task, fromsignal_: Any, tosignal_: Any) -> None:
    """Connect a signal of the program's own to one of the board."""
    task.signals.alias(str(fromsignal_), str(tosignal_).lower())


@routine("WaitDI", "WaitDO")
def wait_digital(
    task: Task,
    signal_: str,
    value_: float,
    maxtime_: float | None = None,
    timeflag_: Any = None,
    visualize_: Any = None,
    header_: Any = None,
    message_: Any = None,
    icon_: Any = None,
    image_: Any = None,
) -> None:
    """Wait until a digital signal has a value."""
    wait_for(task, lambda: task.signals.value(signal_) == value_, f"{signal_} = {value_:g}", maxtime_, timeflag_)


@routine("WaitGI", "WaitGO")
def wait_group(
    task: Task,
    signal_: str,
    noteq_: Any = None,
    lt_: Any = None,
    gt_: Any = None,
    value_: float | None = None,
    dvalue_: float | None = None,
    maxtime_: float | None = None,
    valueattimeout_: Any = None,
    dvalueattimeout_: Any = None,
    timeflag_: Any = None,
) -> None:
    """Wait until a group of signals has a value."""
    goal = value_ if value_ is not None else dvalue_ or 0.0
    holds, word = _relation(lt_, gt_, noteq_)
    _wait(task, signal_, holds, word, goal, maxtime_, timeflag_, valueattimeout_ or dvalueattimeout_)


@routine("WaitAI", "WaitAO")
def wait_analog(
    task: Task,
    signal_: str,
    value_: float,
    lt_: Any = None,
    gt_: Any = None,
    maxtime_: float | None = None,
    valueattimeout_: Any = None,
    timeflag_: Any = None,
    visualize_: Any = None,
    header_: Any = None,
) -> None:
    """Wait until an analog signal is above or below a value."""
    holds, word = _relation(lt_, gt_, None)
    _wait(task, signal_, holds, word, value_, maxtime_, timeflag_, valueattimeout_)


def _relation(lt: Any, gt: Any, noteq: Any) -> tuple[Callable[[float, float], bool], str]:
    if lt:
        return (lambda a, b: a < b), "<"
    if gt:
        return (lambda a, b: a > b), ">"
    return ((lambda a, b: a != b), "<>") if noteq else ((lambda a, b: a == b), "=")


def _wait(
    task: Task,
    signal: str,
    holds: Callable[[float, float], bool],
    word: str,
    goal: float,
    max_time: float | None,
    flag: Any,
    at_timeout: Any,
) -> None:
    try:
        wait_for(task, lambda: holds(task.signals.value(signal), goal), f"{signal} {word} {goal:g}", max_time, flag)
    finally:
        if at_timeout is not None:
            at_timeout[0][at_timeout[1]] = task.signals.value(signal)
