"""Alarms: functions called at a time of the steady clock, by one thread that lives as long as any is set.

For what must be noticed though nothing happens: a deadline missed, a publisher that shows no sign of life.
"""

from __future__ import annotations

import heapq
import itertools
import threading
import time
from collections.abc import Callable


class Alarms:
    """Alarms of one process; safe to use from any thread, and from within an alarm."""

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._heap: list[tuple[int, int, Alarm]] = []
        self._count = itertools.count().__next__
        self._running = False

    def at(self, due_ns: int, action: Callable[[], None]) -> Alarm:
        """Call `action` when ``time.monotonic_ns()`` reaches `due_ns`, unless the alarm is cancelled before."""
        alarm = Alarm(self, action)
        with self._changed:
            heapq.heappush(self._heap, (due_ns, self._count(), alarm))
            if not self._running:
                self._running = True
                threading.Thread(target=self._run, name="alarms", daemon=True).start()
            elif self._heap[0][2] is alarm:
                self._changed.notify()
        return alarm

    def forget(self, alarm: Alarm) -> None:
        """Drop an alarm that was cancelled."""
        with self._changed:
            self._heap = [entry for entry in self._heap if entry[2] is not alarm]
            heapq.heapify(self._heap)
            self._changed.notify()

    def _run(self) -> None:
        while True:
            with self._changed:
                if not self._heap:
                    self._running = False
                    return
                due_ns, _, alarm = self._heap[0]
                left = due_ns - time.monotonic_ns()
                if left > 0:
                    self._changed.wait(left / 1e9)
                    continue
                heapq.heappop(self._heap)
            alarm.action()


class Alarm:
    """One alarm, as `Alarms.at` returns it."""

    __slots__ = ("_alarms", "action")

    def __init__(self, alarms: Alarms, action: Callable[[], None]) -> None:
        self._alarms = alarms
        self.action = action

    def cancel(self) -> None:
        """Do not call after all; it may be in the midst of it."""
        self._alarms.forget(self)


ALARMS = Alarms()
