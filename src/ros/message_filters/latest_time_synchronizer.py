"""Bringing together the latest messages, at the rate of the fastest input."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from typing import Any

from rclpy.clock import Clock, ROSClock

from .simple_filter import SimpleFilter

_SMOOTHING = 0.3


class LatestTimeSynchronizer(SimpleFilter):
    """Synchronizer that passes the latest message of every filter whenever the fastest of them has a new one.

    Stamps do not matter. Which filter is the fastest is found out from how often messages come; until one has
    come from each, nothing is put out.

    Parameters
    ----------
    fs
        The filters to listen to; callbacks get their messages in this order.
    clock
        By which to measure how often they come; ROS time by default.
    """

    def __init__(self, fs: Sequence[SimpleFilter], clock: Clock | None = None) -> None:
        super().__init__()
        self._clock = clock or ROSClock()
        self._lock = threading.Lock()
        self.connectInput(fs)

    def connectInput(self, fs: Sequence[SimpleFilter]) -> None:
        """Listen to filters."""
        self._latest: list[Any] = [None] * len(fs)
        self._arrivals: list[int | None] = [None] * len(fs)
        self._periods_ns: list[float | None] = [None] * len(fs)
        self.input_connections = [one.registerCallback(self.add, index) for index, one in enumerate(fs)]

    def add(self, msg: Any, index: int) -> None:
        """Process a message of one of the filters."""
        with self._lock:
            self._latest[index] = msg
            self._measure(index)
            if None in self._arrivals or index != self._fastest():
                return
            messages = list(self._latest)
        self.signalMessage(*messages)

    def _measure(self, index: int) -> None:
        now = self._clock.now().nanoseconds
        before, period = self._arrivals[index], self._periods_ns[index]
        self._arrivals[index] = now
        if before is not None and now > before:
            passed = float(now - before)
            self._periods_ns[index] = passed if period is None else period + _SMOOTHING * (passed - period)

    def _fastest(self) -> int:
        """Return the filter with the shortest period; one that sent a single message is slower than any other."""
        return min(range(len(self._latest)), key=lambda index: self._periods_ns[index] or float("inf"))
