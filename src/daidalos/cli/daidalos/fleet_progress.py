"""Progress of fleets of runs on standard error."""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from daidalos.testing.journal import Record

_EVERY_S = 10.0


class Progress:
    """Progress on standard error: a line that changes on a terminal, else one every ten seconds.

    Parameters
    ----------
    count : int
        Number of runs.
    done : list of Record
        Those of them that are there already.
    """

    def __init__(self, count: int, done: list[Record]) -> None:
        self._count = count
        self._done = len(done)
        self._failed = sum(not record.passed for record in done)
        self._before = self._done
        self._begun = self._said = time.monotonic()
        if self._before:
            sys.stderr.write(f"{self._before} of {count} runs are there already\n")

    def add(self, record: Record) -> None:
        """Count a result."""
        self._done += 1
        self._failed += not record.passed
        now = time.monotonic()
        if sys.stderr.isatty() or now - self._said >= _EVERY_S:
            self._said = now
            end = "\r" if sys.stderr.isatty() else "\n"
            sys.stderr.write(f"{self._line(now)}{end}")
            sys.stderr.flush()

    def finish(self) -> None:
        """Write the last line."""
        sys.stderr.write(f"{self._line(time.monotonic())}\n")

    def _line(self, now: float) -> str:
        rate = (self._done - self._before) / max(now - self._begun, 1e-9)
        left = (self._count - self._done) / rate if rate > 0.0 else 0.0
        minutes, seconds = divmod(round(left), 60)
        return (
            f"{self._done} of {self._count} runs, {self._failed} failed, {rate:.2g} runs/s, "
            f"{minutes}:{seconds:02d} min left"
        )
