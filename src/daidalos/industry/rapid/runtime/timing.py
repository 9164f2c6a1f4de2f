"""Predefined routines on time: waiting, clocks, date and time of day."""

from __future__ import annotations

from collections.abc import Callable
from datetime import datetime, timedelta
from typing import TYPE_CHECKING, Any

from daidalos.industry.rapid.runtime.errors import ProgramEnd, RapidError
from daidalos.industry.rapid.runtime.registry import routine

if TYPE_CHECKING:
    from daidalos.industry.rapid.runtime.task import Task
    from daidalos.industry.rapid.runtime.values import Handle

POLL = 0.1
"""Seconds between two looks at a condition that is waited for."""


def wait_for(
    task: Task,
    holds: Callable[[], bool],
    what: str,
    max_time: float | None,
    flag: Any,
    error: str = "ERR_WAIT_MAXTIME",
) -> None:
    """Advance time until a condition holds.

    Raises
    ------
    RapidError
        The error, where it does not hold in the time that is given, and the program has no flag for that.
    FatalError
        Where nothing is left that could make it hold.
    """
    end = task.time + max_time if max_time is not None and max_time < 9e8 else None
    if task.cell is not None:
        task.cell.is_active(task)
    while not holds():
        if end is None:
            task.expect_change(f"waits for {what} for ever: nothing else is left that could change it")
        elif task.time >= end:
            if flag is None:
                raise RapidError(error, f"waited {max_time:g} s for {what}")
            flag[0][flag[1]] = True
            return
        task.pass_time(POLL if end is None else min(POLL, end - task.time), is_poll=True)
    if flag is not None:
        flag[0][flag[1]] = False


@routine("WaitTime")
def wait_time(task: Task, time_: float, inpos_: Any = None) -> None:
    """Wait so many seconds."""
    if time_ < 0:
        raise RapidError("ERR_ARGVALERR", f"WaitTime takes 0 or more seconds, not {time_:g}")
    if inpos_ or time_ == 0:
        task.wait_for_robot(task.robot.remaining)
    task.pass_time(time_)


@routine("WaitUntil")
def wait_until(
    task: Task,
    cond_: Callable[[], bool],
    inpos_: Any = None,
    maxtime_: float | None = None,
    timeflag_: Any = None,
    pollrate_: float | None = None,
    visualize_: Any = None,
    header_: Any = None,
    message_: Any = None,
    icon_: Any = None,
    image_: Any = None,
) -> None:
    """Wait until a condition holds."""
    wait_for(task, cond_, "a condition", maxtime_, timeflag_)


@routine("WaitRob")
def wait_robot(task: Task, inpos_: Any = None, zerospeed_: Any = None) -> None:
    """Wait until the robot stands."""
    task.wait_for_robot(task.robot.remaining)


@routine("WaitTestAndSet")
def wait_test_and_set(task: Task, object_: Any) -> None:
    """Wait until a flag is FALSE, and set it."""
    wait_for(task, lambda: not object_[0][object_[1]], "a flag to be FALSE", None, None)
    object_[0][object_[1]] = True


@routine("TestAndSet")
def test_and_set(task: Task, object_: Any) -> bool:
    """Set a flag, and return whether it was FALSE."""
    was_free = not object_[0][object_[1]]
    object_[0][object_[1]] = True
    return was_free


@routine("Stop")
def stop(task: Task, noregain_: Any = None, allmovetasks_: Any = None) -> None:
    """Stop the program; it goes on where the operator wants it to."""
    if task.settings.get("goes_on_after_stop"):
        return
    raise ProgramEnd("Stop")


@routine("Break")
def break_(task: Task) -> None:
    """Stop the program, for a debugger."""
    raise ProgramEnd("Break")


# Clocks


@routine("ClkReset")
def clock_reset(task: Task, clock_: Handle) -> None:
    """Set a clock to 0 and stop it."""
    clock_.state = (0.0, None)


@routine("ClkStart")
def clock_start(task: Task, clock_: Handle) -> None:
    """Start a clock."""
    elapsed, since = clock_.state or (0.0, None)
    clock_.state = (elapsed, task.time if since is None else since)


@routine("ClkStop")
def clock_stop(task: Task, clock_: Handle) -> None:
    """Stop a clock."""
    clock_.state = (clock_read(task, clock_), None)


@routine("ClkRead")
def clock_read(task: Task, clock_: Handle, highres_: Any = None) -> float:
    """Return the seconds that a clock has run."""
    elapsed, since = clock_.state or (0.0, None)
    return float(elapsed + (task.time - since if since is not None else 0.0))


def _now(task: Task) -> datetime:
    return task.now + timedelta(seconds=task.time)


@routine("CDate")
def date(task: Task) -> str:
    """Return the date."""
    return _now(task).strftime("%Y-%m-%d")


@routine("CTime")
def time_of_day(task: Task) -> str:
    """Return the time of day."""
    return _now(task).strftime("%H:%M:%S")


@routine("GetTime")
def get_time(task: Task, wday_: Any = None, hour_: Any = None, min_: Any = None, sec_: Any = None) -> float:
    """Return the day of the week, from Monday as 1, the hour, the minute or the second."""
    now = _now(task)
    return float(now.isoweekday() if wday_ else now.hour if hour_ else now.minute if min_ else now.second)
