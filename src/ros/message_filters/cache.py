"""Remembering messages by their time."""

from __future__ import annotations

import threading
from bisect import bisect_left, bisect_right
from typing import Any

from rclpy.clock import ROSClock
from rclpy.time import Time

from .message_traits import get_time_from_message_header, warn_of_headerless
from .simple_filter import SimpleFilter


class Cache(SimpleFilter):
    """Filter that stores the newest messages, sorted by their stamps, and passes every message on.

    Parameters
    ----------
    f
        The filter to listen to.
    cache_size
        How many messages to remember.
    allow_headerless
        Whether messages without a stamp get the time of their arrival, instead of being dropped.
    """

    def __init__(self, f: SimpleFilter, cache_size: int = 1, allow_headerless: bool = False) -> None:
        super().__init__()
        self.cache_size = cache_size
        self.allow_headerless = allow_headerless
        self.cache_msgs: list[Any] = []
        self.cache_times: list[Time] = []
        self._stamps: list[int] = []
        self._lock = threading.Lock()
        self.connectInput(f)

    def connectInput(self, f: SimpleFilter) -> None:
        """Listen to a filter."""
        self.incoming_connection = f.registerCallback(self.add)

    def add(self, msg: Any) -> None:
        """Process a message."""
        time = get_time_from_message_header(msg)
        if time is None:
            if not self.allow_headerless:
                warn_of_headerless("message_filters_cache")
                return
            time = ROSClock().now()
        with self._lock:
            place = bisect_right(self._stamps, time.nanoseconds)
            self._stamps.insert(place, time.nanoseconds)
            self.cache_times.insert(place, time)
            self.cache_msgs.insert(place, msg)
            if len(self._stamps) > self.cache_size:
                del self._stamps[0], self.cache_times[0], self.cache_msgs[0]
        self.signalMessage(msg)

    def getInterval(self, from_stamp: Time, to_stamp: Time) -> list[Any]:
        """Return the messages from one time to another, both included."""
        assert from_stamp <= to_stamp, f"the interval ends at {to_stamp}, before it begins at {from_stamp}"
        with self._lock:
            begin = bisect_left(self._stamps, from_stamp.nanoseconds)
            return self.cache_msgs[begin : bisect_right(self._stamps, to_stamp.nanoseconds)]

    def getElemAfterTime(self, stamp: Time) -> Any:
        """Return the oldest message that is not older than a time, None when there is none."""
        with self._lock:
            place = bisect_left(self._stamps, stamp.nanoseconds)
            return self.cache_msgs[place] if place < len(self.cache_msgs) else None

    def getElemBeforeTime(self, stamp: Time) -> Any:
        """Return the newest message that is not newer than a time, None when there is none."""
        with self._lock:
            place = bisect_right(self._stamps, stamp.nanoseconds)
            return self.cache_msgs[place - 1] if place else None

    def getLastestTime(self) -> Time | None:
        """Return the newest time, None when there is none."""
        with self._lock:
            return self.cache_times[-1] if self.cache_times else None

    getLatestTime = getLastestTime

    def getOldestTime(self) -> Time | None:
        """Return the oldest time, None when there is none."""
        with self._lock:
            return self.cache_times[0] if self.cache_times else None

    def getLast(self) -> Any:
        """Return the newest message, None when there is none."""
        with self._lock:
            return self.cache_msgs[-1] if self.cache_msgs else None
