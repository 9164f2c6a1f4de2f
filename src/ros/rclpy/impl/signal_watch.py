"""Seeing to it that the handler of a signal runs.

Python runs handlers in the main thread. A signal that comes just before that thread begins to wait, or that the system
hands to another thread, does not wake it: the handler would run when something else does, perhaps never. So the numbers
of all signals go into a pipe (`signal.set_wakeup_fd`) that a handler empties when it runs, and another thread sends a
signal to the main thread again whose number stays there.
"""

from __future__ import annotations

import os
import select
import signal
import threading
import time
import weakref
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from types import FrameType
from typing import Any

_TIMEOUT_S = 0.1
_runs = 0
_reader: int | None = None
_writer: int | None = None
_watched: weakref.WeakSet[Any] = weakref.WeakSet()
_wake: Callable[[], None] | None = None


def watched(handler: Callable[[int, FrameType | None], Any]) -> Callable[[int, FrameType | None], Any]:
    """Return a handler that is seen to run, for `signal.signal`."""

    def run(number: int, frame: FrameType | None) -> Any:
        global _runs
        _runs += 1
        if _reader is not None:
            _take(_reader)
        return handler(number, frame)

    _watched.add(run)
    return run


def start() -> None:
    """Start watching, unless other code, such as asyncio, receives the signals; only the main thread can."""
    global _reader, _writer
    if _writer is not None or not hasattr(signal, "pthread_kill"):
        return
    reader, writer = os.pipe()
    for end in (reader, writer):
        os.set_blocking(end, False)
    other = signal.set_wakeup_fd(writer, warn_on_full_buffer=False)
    if other != -1:
        signal.set_wakeup_fd(other)
        os.close(reader)
        os.close(writer)
        return
    _reader, _writer = reader, writer
    threading.Thread(target=_watch, args=(reader,), name="signals", daemon=True).start()


def stop() -> None:
    """Stop watching; only the main thread can."""
    global _reader, _writer
    if _writer is None:
        return
    present = signal.set_wakeup_fd(-1)
    if present not in (-1, _writer):
        signal.set_wakeup_fd(present)
    os.close(_writer)
    _reader = _writer = None


def is_watching() -> bool:
    """Return whether signals are seen."""
    return _writer is not None


def on_signal(wake: Callable[[], None] | None) -> None:
    """Call `wake` when a signal comes, so that the main thread returns from a wait that signals do not end."""
    global _wake
    _wake = wake


@contextmanager
def watching(number: int) -> Iterator[None]:
    """Watch a signal that somebody handles already, as long as the ``with`` block lasts."""
    handler = signal.getsignal(number)
    if not callable(handler) or threading.current_thread() is not threading.main_thread():
        yield
        return
    seen = watched(handler)
    signal.signal(number, seen)
    start()
    try:
        yield
    finally:
        stop()
        if signal.getsignal(number) is seen:
            signal.signal(number, handler)


def _watch(reader: int) -> None:
    main = threading.main_thread()
    poll = select.poll()
    poll.register(reader, select.POLLIN)
    resent = -1  # the number of runs there had been when a signal was sent again
    while True:
        before = _runs
        poll.poll()
        _end_wait()
        time.sleep(_TIMEOUT_S)
        numbers = _take(reader)
        if numbers is None or reader != _reader:
            break  # what is left belongs to a watch that has ended
        if _runs != before:
            _put_back(numbers)  # they may have come since then: they have their own time
        elif numbers and before != resent and main.ident is not None and signal.getsignal(numbers[-1]) in _watched:
            resent = before
            signal.pthread_kill(main.ident, numbers[-1])
            _end_wait()
    os.close(reader)


def _end_wait() -> None:
    wake = _wake
    if wake is not None:
        wake()


def _take(reader: int) -> bytes | None:
    """Return the numbers of the signals in the pipe, and None when its other end is closed."""
    try:
        return os.read(reader, 64) or None
    except BlockingIOError:
        return b""


def _put_back(numbers: bytes) -> None:
    """Write numbers into the pipe again, unless it was closed meanwhile."""
    if numbers and _writer is not None:
        with suppress(OSError):
            os.write(_writer, numbers)


def _forget() -> None:
    """Disconnect a forked process: the watching thread exists only in its parent."""
    global _reader, _writer
    if _writer is not None:
        signal.set_wakeup_fd(-1)
        _reader = _writer = None


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forget)
