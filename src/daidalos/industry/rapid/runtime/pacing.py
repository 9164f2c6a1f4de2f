"""Pace of programs in real time."""

from __future__ import annotations

import time


class Pace:
    """Pace of real time: a call returns when as much of it has passed as the robot's time has."""

    def __init__(self) -> None:
        self._due = time.monotonic()

    def __call__(self, seconds: float) -> None:
        """Wait until real time has caught up."""
        self._due += seconds
        now = time.monotonic()
        if now < self._due:
            time.sleep(self._due - now)
        else:
            self._due = now
