"""Sections that Ctrl-C must not break off."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager

_depth = 0


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Ignore signals meanwhile, in the main thread: the process is about to end anyway."""
    global _depth
    is_main = threading.current_thread() is threading.main_thread()
    _depth += is_main
    try:
        yield
    finally:
        _depth -= is_main


def is_uninterrupted() -> bool:
    """Return whether the main thread is in such a section."""
    return _depth > 0
