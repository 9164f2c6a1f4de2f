"""Queue of ready entities and timers by deadline, on which an executor waits."""

from __future__ import annotations

import heapq
import itertools
import threading
import time
from collections import deque
from typing import Any

from daidalos.transport.backend import Receiver
from rclpy.impl import signal_watch
from rclpy.impl.timer import TimerHandle

_TIDY = 64
_FOREVER = 2**63 - 1
_MAIN_THREAD = threading.main_thread().ident


class ReadyQueue:
    """A queue that any thread fills and one thread empties.

    The thread that waits sleeps on a lock which who fills the queue releases. Python's own queues are no choice: a
    timed ``SimpleQueue.get`` of CPython may sleep for ever when its time runs out while it wakes.

    Attributes
    ----------
    receiver
        Where the middleware lets a thread that waits receive samples itself, which saves the change of threads for
        each message; None where it does not.
    """

    def __init__(self) -> None:
        self._items: deque[Any] = deque()
        self._first: deque[Any] = deque()
        self._was_first = False
        self._gate = threading.Lock()
        self._gate.acquire()
        self._timers: list[tuple[int, int, int, TimerHandle]] = []
        self._timers_lock = threading.Lock()
        self._tidy_at = _TIDY
        self._count = itertools.count().__next__
        self._waiting_thread: int | None = None
        self._notifying_thread: int | None = None
        self.receiver: Receiver | None = None
        self._receives = False

    def empty(self) -> bool:
        """Return whether nothing waits to be taken."""
        return not self._items and not self._first

    def put(self, item: Any) -> None:
        """Add an item, and wake who waits."""
        self._items.append(item)
        # What `get` itself adds, for timers that are due, it finds without being woken.
        if self._notifying_thread != threading.get_ident():
            self._open()

    def put_first(self, item: Any) -> None:
        """Add an item that comes before those that were added by `put`, of which one may come in between."""
        self._first.append(item)
        self._open()

    def _open(self) -> None:
        if self._gate.locked():
            try:  # noqa: SIM105 - several times faster than `suppress`, for each message
                self._gate.release()
            except RuntimeError:
                pass  # it is open
        if self._receives and self.receiver is not None:
            self.receiver.wake()

    def schedule(self, deadline_ns: int, timer: TimerHandle) -> None:
        """Notify a timer when ``time.monotonic_ns()`` reaches a deadline."""
        with self._timers_lock:
            timers = self._timers
            if len(timers) >= self._tidy_at:
                live = [entry for entry in timers if entry[3].version == entry[2]]
                heapq.heapify(live)
                timers[:] = live  # at once, since `_notify_timers` reads the first without the lock
                self._tidy_at = max(2 * len(timers), _TIDY)
            heapq.heappush(timers, (deadline_ns, self._count(), timer.version, timer))
            earliest = timers[0][3] is timer
        if earliest and self._waiting_thread != threading.get_ident():
            self.put(None)

    def get(self, deadline_ns: int | None) -> Any:
        """Return the next item, and wait for it until ``time.monotonic_ns()`` reaches a deadline.

        Raises
        ------
        TimeoutError
            When the deadline came first.
        """
        items, first, timers, now = self._items, self._first, self._timers, time.monotonic_ns
        thread = self._waiting_thread = threading.get_ident()
        while True:
            until = deadline_ns
            if timers:
                self._notifying_thread = thread
                try:
                    until = self._notify_timers(until)
                finally:
                    self._notifying_thread = None
            if first and not (items and self._was_first):
                self._was_first = True
                return first.popleft()
            if items:
                self._was_first = False
                return items.popleft()
            left = _FOREVER if until is None else until - now()
            if left > 0:
                receiver = self.receiver
                if receiver is None or not self._receive(receiver, left):
                    self._gate.acquire(True, -1 if until is None else left / 1e9)
            elif until == deadline_ns:
                raise TimeoutError

    def _receive(self, receiver: Receiver, timeout_ns: int) -> bool:
        """Wait for samples, and queue whom they make ready; return False where another thread does that."""
        is_main = self._waiting_thread == _MAIN_THREAD
        if is_main and not signal_watch.is_watching():
            return False  # nothing would end the wait for a signal's handler
        if not receiver.enter():
            return False
        try:
            self._receives = True
            if is_main:
                signal_watch.on_signal(receiver.wake)
            ready = () if self._items or self._first else receiver.wait(timeout_ns)
            self._receives = False
            receiver.handle(ready)
        finally:
            self._receives = False
            if is_main:
                signal_watch.on_signal(None)
            receiver.leave()
        return True

    def _notify_timers(self, until: int | None) -> int | None:
        """Notify the timers that are due, and return the earliest of `until` and the next timer's deadline."""
        timers = self._timers
        while True:
            try:
                first = timers[0]  # without the lock: each change leaves a heap, and an earlier timer wakes this thread
            except IndexError:
                return until
            deadline, _, version, timer = first
            if timer.version == version and deadline > time.monotonic_ns():
                return deadline if until is None or deadline < until else until
            with self._timers_lock:
                if not timers or timers[0] is not first:
                    continue
                heapq.heappop(timers)
            if timer.version == version:
                timer.on_due()
