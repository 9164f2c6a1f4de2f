"""Numbers of nodes and endpoints, reused for equal entities.

zenoh never forgets a token's key once another process has heard of it, some kilobytes each. An entity that is made
like one that is gone, as by who makes a client for every call, gets its number, and with it its token.
"""

from __future__ import annotations

import itertools
import threading
import time
from collections import deque
from collections.abc import Hashable

_REST_S = 2.0
"""Time before a number is reused, since samples under it and the notice of its end may be in transit."""
_MAX_ENTITIES = 10_000
"""Number of different entities whose free numbers are remembered."""


class EntityIds:
    """Allocator of numbers from 0 upwards; safe to use from any thread."""

    def __init__(self) -> None:
        self._next = itertools.count().__next__
        self._lock = threading.Lock()
        self._free: dict[Hashable, deque[tuple[float, int]]] = {}

    def acquire(self, what: Hashable) -> int:
        """Return a number for an entity; `what` is the content of its token apart from the number."""
        with self._lock:
            free = self._free.get(what)
            if free and time.monotonic() - free[0][0] >= _REST_S:
                return free.popleft()[1]
        return self._next()

    def release(self, what: Hashable, number: int) -> None:
        """Release the number of an entity."""
        with self._lock:
            if len(self._free) >= _MAX_ENTITIES and what not in self._free:
                self._free.clear()
            self._free.setdefault(what, deque()).append((time.monotonic(), number))
