"""Predefined routines with which tasks wait for each other, and move together."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from daidalos.industry.rapid.runtime.errors import FatalError, RapidError
from daidalos.industry.rapid.runtime.registry import routine
from daidalos.industry.rapid.runtime.robot import Move
from daidalos.industry.rapid.runtime.timing import wait_for

if TYPE_CHECKING:
    from daidalos.industry.rapid.runtime.task import Task


def meet(task: Task, point: str, group: tuple[str, ...], timeout: float | None = None) -> None:
    """Wait until all tasks of a group are at a point.

    Raises
    ------
    RapidError
        ERR_WAITSYNCTASK, where the others do not come in time.
    FatalError
        Where a task does not run, or nothing is left that could bring it to the point.
    """
    if task.cell is None:
        others = ", ".join(one for one in group if one != task.name)
        raise FatalError(f"waits for {others or 'other tasks'}, and this task runs alone; name all tasks with --task")
    if task.name not in group:
        raise FatalError(f"the task {task.name} is not in its own list of tasks: {', '.join(group)}")
    holds = task.cell.arrive(task, point, group)
    what = f"all of {', '.join(group)} to be at {point}"
    try:
        wait_for(task, holds, what, timeout, None, "ERR_WAITSYNCTASK")
    finally:
        task.cell.leave(task, point)


def _names(tasks: list[Any]) -> tuple[str, ...]:
    return tuple(str(one[0]).upper() for one in tasks if one[0])


def together(task: Task) -> tuple[str, ...] | None:
    """Return the names of the tasks that move together with a task; None where it moves by itself."""
    found: tuple[str, ...] | None = task.settings.get("together")
    return found


def order_together(task: Task, move: Move, number: float | None) -> None:
    """Order a movement that begins and ends with those of the other tasks; the slowest sets the time.

    Each of these movements ends with a stop.

    Raises
    ------
    FatalError
        Where it has no identity, or another one than those of the other tasks.
    """
    group = together(task)
    assert group is not None
    assert task.cell is not None
    if number is None:
        raise FatalError("a movement between SyncMoveOn and SyncMoveOff needs \\ID")
    cell = task.cell
    task.wait_for_robot(task.robot.remaining)
    cell.numbers[task.name] = number
    meet(task, "the next movement", group)
    for name in group:
        if cell.numbers[name] != number:
            text = f"this task has \\ID:={number:g}, and {name} has \\ID:={cell.numbers[name]:g}"
            raise FatalError(f"tasks that move together need the same movements: {text}")
    task.robot.order(move)
    meet(task, f"the movement \\ID:={number:g}", group)
    robots = [cell.tasks[name].robot for name in group]
    leader = max(robots, key=lambda one: one.remaining())
    if task.name == group[0]:
        slowing = max((one.follow(leader) for one in robots if one is not leader), default=1.0)
        for one in robots:
            one.stretch(slowing * one.remaining())
    meet(task, f"the beginning of the movement \\ID:={number:g}", group)
    task.wait_for_robot(task.robot.remaining)


@routine("WaitSyncTask")
def wait_sync_task(
    task: Task, syncid_: str, tasklist_: list[Any], inpos_: Any = None, timeout_: float | None = None
) -> None:
    """Wait until all tasks of a list are at this point."""
    if inpos_:
        task.wait_for_robot(task.robot.remaining)
    meet(task, syncid_, _names(tasklist_), timeout_)


@routine("SyncMoveOn")
def sync_move_on(task: Task, syncid_: str, tasklist_: list[Any], timeout_: float | None = None) -> None:
    """Wait for the tasks of a list, and move together with them from now on."""
    if together(task) is not None:
        raise RapidError("ERR_SYNCMOVEON", "the tasks move together already")
    task.wait_for_robot(task.robot.remaining)
    names = _names(tasklist_)
    meet(task, syncid_, names, timeout_)
    task.settings["together"] = names


@routine("SyncMoveOff")
def sync_move_off(task: Task, syncid_: str, timeout_: float | None = None) -> None:
    """Wait for the tasks that move together, and move by itself from now on."""
    group = together(task)
    if group is None:
        raise RapidError("ERR_SYNCMOVEOFF", "the tasks do not move together; SyncMoveOn comes first")
    task.wait_for_robot(task.robot.remaining)
    meet(task, syncid_, group, timeout_)
    task.settings.pop("together")


@routine("SyncMoveUndo")
def sync_move_undo(task: Task) -> None:
    """Move by itself again, in all tasks that move together, without waiting for them."""
    group = together(task)
    if group is not None and task.cell is not None:
        for name in group:
            task.cell.tasks[name].settings.pop("together", None)


@routine("SyncMoveSuspend")
def sync_move_suspend(task: Task) -> None:
    """Move by itself until SyncMoveResume."""
    task.settings["suspended"] = task.settings.pop("together", None)


@routine("SyncMoveResume")
def sync_move_resume(task: Task) -> None:
    """Move together again as before SyncMoveSuspend."""
    group = task.settings.pop("suspended", None)
    if group is not None:
        meet(task, "SyncMoveResume", group)
        task.settings["together"] = group


@routine("IsSyncMoveOn")
def is_sync_move_on(task: Task) -> bool:
    """Return whether the task moves together with others."""
    return together(task) is not None


@routine("GetTaskName")
def task_name(task: Task, taskno_: Any = None, mectaskno_: Any = None) -> str:
    """Return the name of the task, and its number among the tasks."""
    names = list(task.cell.tasks) if task.cell is not None else [task.name]
    number = float(names.index(task.name) + 1)
    for one in (taskno_, mectaskno_):
        if one is not None:
            one[0][one[1]] = number
    return task.name


@routine("TaskRunMec")
def moves_units(task: Task) -> bool:
    """Return whether the task moves a robot."""
    return True


@routine("TaskRunRob")
def moves_robot(task: Task) -> bool:
    """Return whether the task moves a robot with a tool."""
    return True
