"""Closing of what the garbage collector found, in threads that end before the interpreter does."""

from __future__ import annotations

import _thread
from collections.abc import Callable

_CLOSING_S = 2.0


class AbandonedObjects:
    """Closer of unreferenced objects.

    The garbage collector finds such objects on any thread, with any lock held: they are closed on another.
    """

    def __init__(self) -> None:
        self._pending: list[_thread.LockType] = []  # changed without a lock, as `close` may interrupt its holder
        self._refused = False

    def close(self, close: Callable[[], None]) -> None:
        """Call a function in a thread; it must not refer to the object. After `finish` nothing is called."""
        if self._refused:
            return
        done = _thread.allocate_lock()
        done.acquire()

        def run() -> None:
            try:
                close()
            finally:
                self._pending.remove(done)
                done.release()

        self._pending.append(done)
        try:
            _thread.start_new_thread(run, ())
        except RuntimeError:  # the process ends, and all is closed anyway
            self._pending.remove(done)

    def finish(self) -> None:
        """Wait for the calls under way, each for two seconds at most, and refuse further ones.

        A thread inside the middleware must not outlive the interpreter.
        """
        self._refused = True
        for done in tuple(self._pending):
            done.acquire(timeout=_CLOSING_S)
