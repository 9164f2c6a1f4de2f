"""Tasks that run at the same time, on one clock and one board of signals.

Each task has a thread of its own, and one of them runs at a time: that whose time is the earliest, or the first of
those whose times are equal. A task gives the others their turn where time passes. The same programs give the same run.
"""

from __future__ import annotations

import ctypes
import threading
from collections.abc import Callable, Collection, Mapping

from daidalos.common.suggestions import hint
from daidalos.industry.rapid.runtime.errors import FatalError, ProgramEnd
from daidalos.industry.rapid.runtime.names import global_name
from daidalos.industry.rapid.runtime.task import Outcome, Task
from daidalos.industry.rapid.symbols import Type

STOPPED = "another task"
"""Reason of the end of a task that an error in another one has stopped."""

_LOOK_S = 0.2
"""Seconds between two looks at signals such as Ctrl-C."""

_GIVE_UP_S = 2.0
"""Seconds that an interrupted task has to end, such as one that waits for the operator."""


class Cell:
    """The tasks of a controller.

    Parameters
    ----------
    tasks
        The tasks by their names, in the order in which they run where they are at the same time. Each has its own
        robot, and they share one board.
    pace
        Called with each span of time in seconds before the tasks go on, to let as much real time pass.

    Raises
    ------
    FatalError
        Where two tasks declare a persistent of one name with different types.
    """

    def __init__(self, tasks: Mapping[str, Task], pace: Callable[[float], None] | None = None) -> None:
        self.tasks = dict(tasks)
        self.time = 0.0
        self.points: dict[str, set[str]] = {}
        """The tasks that have arrived at each point where tasks meet."""
        self.numbers: dict[str, float] = {}
        """The identity of the movement of each task that moves together with others."""
        self._pace = pace
        self._order = {name: index for index, name in enumerate(self.tasks)}
        self._wake = dict.fromkeys(self.tasks, 0.0)
        self._turns = {name: threading.Semaphore(0) for name in self.tasks}
        self._yielded = threading.Semaphore(0)
        self._threads: dict[str, threading.Thread] = {}
        self._running: str | None = None
        self._version = 0
        self._looked: dict[str, int] = {}
        self._outcomes: dict[str, Outcome] = {}
        self._is_stopping = False
        for name, task in self.tasks.items():
            task.cell, task.name = self, name
        next(iter(self.tasks.values())).signals.listeners.append(self._on_signal)
        self._shared: dict[str, object] = {}
        self._sharing: dict[str, list[str]] = {name: [] for name in self.tasks}
        self._share_persistents()

    # Running

    def run(self, procedure: str = "main") -> dict[str, Outcome]:
        """Run a procedure of each task; an error in one stops all, as Ctrl-C does."""
        for name in self.tasks:
            self._threads[name] = threading.Thread(target=self._run_one, args=(name, procedure), daemon=True)
            self._threads[name].start()
        while self._wake or self._running:
            try:
                self._take_turn()
            except KeyboardInterrupt:
                if self._is_stopping:
                    break
                self._interrupt()
        for name in self.tasks:
            self._import(name)
            self._outcomes.setdefault(name, Outcome("interrupted", "interrupted", self.time))
        return {name: self._outcomes[name] for name in self.tasks}

    def running(self) -> tuple[Task, int] | None:
        """Return the task whose turn it is, and the identifier of its thread; None while time passes."""
        name = self._running
        thread = self._threads[name].ident if name is not None else None
        return (self.tasks[name], thread) if name is not None and thread is not None else None

    def _take_turn(self) -> None:
        if self._running is None:
            name = min(self._wake, key=lambda one: (self._wake[one], self._order[one]))
            if self._pace is not None and self._wake[name] > self.time:
                self._pace(self._wake[name] - self.time)
            self.time = max(self._wake.pop(name), self.time)
            self._running = name
            self._turns[name].release()
        while not self._yielded.acquire(timeout=_LOOK_S):
            pass  # a signal that another thread has received does not end the wait
        self._running = None

    def _run_one(self, name: str, procedure: str) -> None:
        self._turns[name].acquire()
        self._import(name)
        outcome = self.tasks[name].run(procedure)
        self._export(name)
        self._outcomes[name] = outcome
        if outcome.reason in ("error", "interrupted"):
            self._stop()
        self._version += 1
        self._yielded.release()

    def _stop(self) -> None:
        self._is_stopping = True
        self._wake = dict.fromkeys(self._wake, self.time)

    def _interrupt(self) -> None:
        """Interrupt the task that runs, and have the others stop."""
        self._stop()
        if self._running is None:
            return
        thread = self._threads[self._running]
        if thread.ident is not None:
            ctypes.pythonapi.PyThreadState_SetAsyncExc(
                ctypes.c_ulong(thread.ident), ctypes.py_object(KeyboardInterrupt)
            )
        if not self._yielded.acquire(timeout=_GIVE_UP_S):
            self._wake.clear()
        self._running = None

    # Called by tasks

    def sleep(self, task: Task, time: float) -> float:
        """Wait, while the other tasks run, until a time, or until the task is woken; return the time then.

        Raises
        ------
        ProgramEnd
            Where all tasks are stopped.
        """
        name = task.name
        if self._looked.get(name) != self._version:
            self._version += 1
        self._wake[name] = time if not self._is_stopping else self.time
        self._export(name)
        self._yielded.release()
        self._turns[name].acquire()
        self._import(name)
        if self._is_stopping:
            raise ProgramEnd(STOPPED)
        return self.time

    def wake(self, task: Task) -> None:
        """Wake a task that sleeps at the present time."""
        if task.name in self._wake:
            self._wake[task.name] = min(self._wake[task.name], self.time)
            self._looked.pop(task.name, None)

    def is_active(self, task: Task) -> None:
        """Record that a task has done something which others may wait for."""
        self._version += 1

    def can_change(self, task: Task) -> bool:
        """Return whether another task may end what a task waits for, which has just looked in vain.

        No task can where all others have looked in vain too since the latest of them did something, and none has a
        timer.
        """
        self._looked[task.name] = self._version
        others = [one for one in self.tasks if one not in self._outcomes and one != task.name]
        return any(
            self._looked.get(one) != self._version or self.tasks[one].interrupts.next_time() is not None
            for one in others
        )

    def _on_signal(self, _key: str, _value: float) -> None:
        """Wake the tasks that poll a condition."""
        for name in self._looked:
            if name != self._running and name in self._wake:
                self._wake[name] = min(self._wake[name], self.time)
        self._version += 1

    def arrive(self, task: Task, point: str, group: Collection[str]) -> Callable[[], bool]:
        """Arrive at a point where tasks meet; return what says whether all have arrived.

        Raises
        ------
        FatalError
            Where a task of the group is none of the cell's.
        """
        unknown = [one for one in group if one not in self._order]
        if unknown:
            raise FatalError(f"there is no task '{unknown[0]}' in this run{hint(unknown[0], self._order)}")
        arrived = self.points.setdefault(point, set())
        arrived.add(task.name)
        if arrived >= set(group):
            del self.points[point]
            for one in group:
                self.wake(self.tasks[one])
        return lambda: arrived >= set(group)

    def leave(self, task: Task, point: str) -> None:
        """Leave a point at which not all tasks have arrived in time."""
        self.points.get(point, set()).discard(task.name)

    # Persistents

    def _share_persistents(self) -> None:
        """Make one value of the persistents that several tasks declare: that of the first task."""
        first: dict[str, tuple[str, Type]] = {}
        for name, task in self.tasks.items():
            for owned, node, value in task.persistents():
                if owned.scope:
                    continue
                key, type_ = global_name(owned), Type(node.type.key, len(node.dimensions))
                if key not in first:
                    first[key] = (name, type_)
                    self._shared[key] = value
                    self._sharing[name].append(key)
                    continue
                other, known = first[key]
                if known != type_:
                    text = f"is {known.name} in {other}, and {type_.name} in {name}"
                    raise FatalError(f"the persistent '{owned.symbol.name}' {text}; tasks share persistents by name")
                self._sharing[name].append(key)
                task.write(key, self._shared[key])

    def _export(self, name: str) -> None:
        self._shared.update((key, self.tasks[name].read(key)) for key in self._sharing[name])

    def _import(self, name: str) -> None:
        for key in self._sharing[name]:
            self.tasks[name].write(key, self._shared[key])
