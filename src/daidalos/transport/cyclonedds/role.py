"""Handing over of a task between the thread that exists for it and threads that are at hand."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

_ABSENCE_S = 0.005
"""Time after which the own thread goes on where nobody has come back."""


class Role:
    """A task that one thread at a time does: its own one, or a visitor that comes and goes.

    A visitor comes for a short while, again and again. In between the task rests; the own thread takes it up when
    nobody has come for `_ABSENCE_S`. While a visitor stays for long, the own thread sleeps.
    """

    def __init__(self) -> None:
        self.is_wanted = False
        self._taken = threading.Lock()
        self._bell = threading.Lock()
        self._bell.acquire()
        self._sleeps = False
        self._is_urgent = False
        self._ended = False
        self._visits = 0

    # Of visitors.

    def enter(self) -> bool:
        """Take the task, unless somebody has it; the own thread then gives it up as soon as it can."""
        if self._ended or not self._taken.acquire(False):
            self.is_wanted = True
            return False
        self.is_wanted = False
        self._visits += 1
        return True

    def leave(self) -> None:
        """Give up the task."""
        self._taken.release()
        if self._sleeps:
            self._ring()

    def give_back(self) -> None:
        """Give the task to the own thread at once."""
        self._is_urgent = True
        self._taken.release()
        self._ring()

    # Of the own thread.

    @contextmanager
    def own(self) -> Iterator[None]:
        """Hold the task for a ``with`` block, after a wait for whoever has it."""
        with self._taken:
            self._is_urgent = False
            yield

    def stand_by(self) -> None:
        """Wait until the own thread is needed."""
        while not self._ended:
            visits = self._visits
            rung = self._bell.acquire(True, -1 if self._sleeps else _ABSENCE_S)
            self._sleeps = False
            if self._is_urgent:
                return
            if rung or visits != self._visits:
                continue
            if not self._taken.locked():
                return
            self._sleeps = True  # somebody has stayed all the time; who leaves rings
            if not self._taken.locked():
                self._sleeps = False

    def end(self) -> None:
        """Wake the own thread for its end; nobody can enter any more."""
        self._ended = True
        self._ring()

    def wait_until_free(self, timeout_s: float) -> None:
        """Wait until nobody has the task."""
        deadline = time.monotonic() + timeout_s
        if self._taken.acquire(True, max(deadline - time.monotonic(), 0.0)):
            self._taken.release()

    def _ring(self) -> None:
        try:  # noqa: SIM105 - several times faster than `suppress`
            self._bell.release()
        except RuntimeError:
            pass  # it has rung
