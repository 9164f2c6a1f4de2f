"""Zenoh's threads in Python: which there are, and what keeps calls from them cheap."""

from __future__ import annotations

import ctypes
import threading
from collections.abc import Callable
from typing import Any


def on_lasting_thread(callback: Callable[[Any], None]) -> Callable[[Any], None]:
    """Return what calls `callback` from a thread of zenoh's, at a fraction of the cost.

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
    """What is known of the present thread."""

    is_kept = False


_LOCAL = _Local()
