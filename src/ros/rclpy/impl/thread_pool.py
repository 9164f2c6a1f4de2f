"""A pool of threads in which a thread that only waits makes room for another."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from queue import SimpleQueue
from typing import Any


class ThreadPool:
    """Pool of threads that run functions, at most `size` at a time; its threads end with `close`."""

    def __init__(self, size: int) -> None:
        self._max_workers = size
        self._lock = threading.Lock()
        self._work: SimpleQueue[tuple[Callable[..., Any], tuple[Any, ...]] | None] = SimpleQueue()
        self._threads = 0  # those that are not blocked
        self._load = 0  # functions that wait for a thread or are carried out, those that are blocked excepted
        self._blocked = 0
        self._closed = False
        self._alive: set[threading.Thread] = set()

    def submit(self, function: Callable[..., Any], *arguments: Any) -> None:
        """Run a function, which must raise nothing, in a thread of the pool."""
        self._work.put((function, arguments))
        with self._lock:
            self._load += 1
            self._grow()

    def _grow(self) -> None:
        if self._threads < min(self._load, self._max_workers) and not self._closed:
            self._threads += 1
            thread = threading.Thread(target=self._run, name="rclpy", daemon=True)
            self._alive.add(thread)
            thread.start()

    def _run(self) -> None:
        try:
            self._work_on()
        finally:
            with self._lock:
                self._alive.discard(threading.current_thread())

    def _work_on(self) -> None:
        while True:
            item = self._work.get()
            if item is None:
                return
            item[0](*item[1])
            item = None  # what was carried out may be collected while the thread waits
            with self._lock:
                self._load -= 1
                if self._threads > self._max_workers:
                    self._threads -= 1
                    return

    @contextmanager
    def blocked(self) -> Iterator[None]:
        """Mark the function of a thread of the pool as waiting: another one may take its place."""
        with self._lock:
            self._blocked += 1
            self._load -= 1
            self._threads -= 1
            self._grow()
        try:
            yield
        finally:
            with self._lock:
                self._blocked -= 1
                self._load += 1
                self._threads += 1

    def close(self) -> None:
        """Stop the threads, after the functions that they run."""
        with self._lock:
            if self._closed:
                return
            self._closed = True
            for _ in range(self._threads + self._blocked):
                self._work.put(None)

    def join(self) -> None:
        """Wait until the threads have ended, after `close`; the calling thread may be one of them."""
        with self._lock:
            threads = self._alive - {threading.current_thread()}
        for thread in threads:
            thread.join()


def processors() -> int:
    """Return how many processors this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
