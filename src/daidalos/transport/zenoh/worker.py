"""Thread that calls zenoh on behalf of zenoh's callbacks.

Zenoh calls back while it holds locks of its routing tables, as at the end of a query whose peer has gone. A callback
that queried in its turn would wait for these locks for ever, and with it every other call of the session.
"""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from queue import SimpleQueue

_LOGGER = logging.getLogger(__name__)
_CLOSING_S = 1.0
"""Timeout for the call under way when the worker is closed."""


class Worker:
    """Thread that makes calls one after the other; it starts with the first."""

    def __init__(self) -> None:
        self._calls: SimpleQueue[Callable[[], None] | None] = SimpleQueue()
        self._lock = threading.Lock()
        self._thread: threading.Thread | None = None
        self._closed = False

    def submit(self, call: Callable[[], None]) -> None:
        """Make a call on the thread; after `close`, none is made."""
        if self._thread is None:
            self._start()
        self._calls.put(call)

    def close(self) -> None:
        """Drop the calls that wait, and end the thread."""
        with self._lock:
            self._closed = True
            thread = self._thread
        self._calls.put(None)
        if thread is not None and thread is not threading.current_thread():
            thread.join(_CLOSING_S)

    def _start(self) -> None:
        with self._lock:
            if self._thread is None and not self._closed:
                self._thread = threading.Thread(target=self._run, name="history", daemon=True)
                self._thread.start()

    def _run(self) -> None:
        while (call := self._calls.get()) is not None and not self._closed:
            try:
                call()
            except Exception:  # one failed call must not prevent all others
                _LOGGER.exception("a query failed")
