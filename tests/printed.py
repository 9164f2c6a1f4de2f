"""The lines that another process prints, read as they come."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterable
from typing import TypeVar

T = TypeVar("T")


class Printed:
    """Reads lines in a thread of its own until there are no more.

    Parameters
    ----------
    source
        Yields them.

    Attributes
    ----------
    lines : list of str
        What came so far.
    """

    def __init__(self, source: Iterable[str]) -> None:
        self.lines: list[str] = []
        self._news = threading.Condition()
        self._reader = threading.Thread(target=self._read, args=(source,), daemon=True)
        self._reader.start()

    def wait(
        self, find: Callable[[], T | None], timeout_s: float, has_ended: Callable[[], bool] = lambda: False
    ) -> T | None:
        """Return what is found in the lines; None when it is not there in time, or who prints has ended without it."""
        deadline = time.monotonic() + timeout_s
        with self._news:
            while True:
                is_last = not self._reader.is_alive() or has_ended()
                found = find()
                left = deadline - time.monotonic()
                if found is not None or left <= 0:
                    return found
                # The last lines may still be on their way.
                if not self._news.wait(min(left, 0.5)) and is_last:
                    return find()

    def join(self) -> None:
        """Wait for the last line."""
        self._reader.join()

    def _read(self, source: Iterable[str]) -> None:
        for line in source:
            with self._news:
                self.lines.append(line.rstrip("\r\n"))
                self._news.notify_all()
        with self._news:
            self._news.notify_all()
