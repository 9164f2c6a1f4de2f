"""Timers on the steady clock, run by one thread that lives as long as any is pending.

For what must be noticed though nothing happens: a deadline missed, a publisher that shows no sign of life.
"""

from __future__ import annotations

import heapq
import itertools
import threading
import time
from collections.abc import Callable


class SteadyTimers:
    """Timers of one process on the steady clock; safe to use from any thread and from within a timer."""

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._heap: list[tuple[int, int, SteadyTimer]] = []
        self._count = itertools.count().__next__
        self._running = False

    def at(self, due_ns: int, action: Callable[[], None]) -> SteadyTimer:
        """Call `action` when ``time.monotonic_ns()`` reaches `due_ns`, unless the timer is cancelled before."""
        timer = SteadyTimer(self, action)
        with self._changed:
            heapq.heappush(self._heap, (due_ns, self._count(), timer))
            if not self._running:
                self._running = True
                threading.Thread(target=self._run, name="steady-timers", daemon=True).start()
            elif self._heap[0][2] is timer:
                self._changed.notify()
        return timer

    def forget(self, timer: SteadyTimer) -> None:
        """Remove a cancelled timer."""
        with self._changed:
            self._heap = [entry for entry in self._heap if entry[2] is not timer]
            heapq.heapify(self._heap)
            self._changed.notify()

    def _run(self) -> None:
        while True:
            with self._changed:
                if not self._heap:
                    self._running = False
                    return
                due_ns, _, timer = self._heap[0]
                left = due_ns - time.monotonic_ns()
                if left > 0:
                    self._changed.wait(left / 1e9)
                    continue
                heapq.heappop(self._heap)
            timer.action()


class SteadyTimer:
    """Timer returned by `SteadyTimers.at`."""

    __slots__ = ("_timers", "action")

    def __init__(self, timers: SteadyTimers, action: Callable[[], None]) -> None:
        self._timers = timers
        self.action = action

    def cancel(self) -> None:
        """Do not call after all; it may be in the midst of it."""
        self._timers.forget(self)


STEADY_TIMERS = SteadyTimers()
