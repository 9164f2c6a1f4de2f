"""Zenoh's threads in Python, and cheap callbacks from them."""

from __future__ import annotations

import ctypes
import os
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

_VARIABLE = "ZENOH_RUNTIME"
_LAYOUT = "(rx: (handover: net), acc: (handover: net))"


@contextmanager
def limit_threads() -> Iterator[None]:
    """Configure zenoh, if it starts in this process, to read each link on its waiting thread.

    It would hand every message to another thread first, which costs a quarter of a round trip. It reads its layout of
    threads once, from the environment, where a user's own stays.
    """
    if _VARIABLE in os.environ:
        yield
        return
    os.environ[_VARIABLE] = _LAYOUT
    try:
        yield
    finally:
        os.environ.pop(_VARIABLE, None)  # programs that we start are not to have it


def on_lasting_thread(callback: Callable[[Any], None]) -> Callable[[Any], None]:
    """Return a callback that calls `callback` from a thread of zenoh at a fraction of the cost.

    For a thread that it did not start, CPython makes a thread state at every call and drops it afterwards. With it
    go a mapping of memory and, on all cores, what they know of it: some 9 us a message. Here the first call keeps
    the state for as long as the process lives, as do these threads.
    """
    local = _LOCAL

    def call(item: Any) -> None:
        if not local.is_kept:
            local.is_kept = True
            ctypes.pythonapi.PyGILState_Ensure()  # never released: the state stays
        callback(item)

    return call


class _Local(threading.local):
    """State of the current thread."""

    is_kept = False


_LOCAL = _Local()
