"""One signal made of several."""

from __future__ import annotations

import threading
from collections.abc import Callable


class ReadyAggregator:
    """Aggregator that calls a function when its own has been called a number of times, from any thread.

    Parameters
    ----------
    ready_fn
        The function.
    num_to_aggregate
        The number of times.
    """

    def __init__(self, ready_fn: Callable[[], None], num_to_aggregate: int) -> None:
        self.__ready_fn = ready_fn
        self.__missing = num_to_aggregate
        self.__lock = threading.Lock()

    def ready_fn(self) -> None:
        """Count one call."""
        with self.__lock:
            self.__missing -= 1
            complete = self.__missing == 0
        if complete:
            self.__ready_fn()
