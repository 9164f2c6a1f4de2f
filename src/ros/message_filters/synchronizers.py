"""Bringing together messages of the same, or nearly the same, time."""

from __future__ import annotations

import threading
from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from typing import Any

from rclpy.clock import ROSClock
from rclpy.duration import Duration

from .message_traits import TimeGetter, get_time_from_message_header, warn_of_headerless
from .simple_filter import SimpleFilter

Queue = dict[int, Any]
"""Messages by their stamps in nanoseconds."""


class TimeSynchronizer(SimpleFilter):
    """Synchronizer that passes messages of several filters together when their stamps are equal.

    Parameters
    ----------
    fs
        The filters to listen to; callbacks get their messages in this order.
    queue_size
        How many messages of each to keep while others are missing.
    time_getter
        Returns the time of a message; the stamp in its header by default.
    """

    def __init__(
        self, fs: Sequence[SimpleFilter], queue_size: int, time_getter: TimeGetter = get_time_from_message_header
    ) -> None:
        super().__init__()
        self.queue_size = queue_size
        self.time_getter = time_getter
        self.lock = threading.Lock()
        self.connectInput(fs)

    def connectInput(self, fs: Sequence[SimpleFilter]) -> None:
        """Listen to filters."""
        self.queues: list[Queue] = [{} for _ in fs]
        self.input_connections = [
            one.registerCallback(self.add, queue, index)
            for index, (one, queue) in enumerate(zip(fs, self.queues, strict=True))
        ]

    def add(self, msg: Any, my_queue: Queue, my_queue_index: int | None = None) -> None:
        """Process a message of one of the filters.

        Raises
        ------
        ValueError
            When it has no stamp.
        """
        time = self.time_getter(msg)
        if time is None:
            raise ValueError(
                f"a {type(msg).__name__} has no stamp to synchronize by; give a 'time_getter' that knows one"
            )
        stamp = time.nanoseconds
        with self.lock:
            self._enqueue(stamp, msg, my_queue)
            if not all(stamp in queue for queue in self.queues):
                return
            messages = [queue.pop(stamp) for queue in self.queues]
        self.signalMessage(*messages)

    def _enqueue(self, stamp: int, msg: Any, queue: Queue) -> None:
        queue[stamp] = msg
        while len(queue) > self.queue_size:
            del queue[min(queue)]


class ApproximateTimeSynchronizer(TimeSynchronizer):
    """Synchronizer that passes messages of several filters together when their stamps are less than `slop` apart.

    Every message looks for partners when it comes: those nearest to it are preferred, of the first filter first.

    Parameters
    ----------
    fs, queue_size, time_getter
        As in `TimeSynchronizer`.
    slop
        In seconds.
    queue_offset
        What to subtract from the stamps of each filter, in nanoseconds. (Up to Jazzy this was the place of
        `allow_headerless`: True is understood as that.)
    allow_headerless
        Whether messages without a stamp get the time of their arrival, instead of being dropped.
    sync_arrival_time
        Whether the time of its arrival counts for every message.
    """

    def __init__(
        self,
        fs: Sequence[SimpleFilter],
        queue_size: int,
        slop: float,
        queue_offset: Sequence[int] | bool = False,
        allow_headerless: bool = False,
        sync_arrival_time: bool = False,
        time_getter: TimeGetter = get_time_from_message_header,
    ) -> None:
        super().__init__(fs, queue_size, time_getter)
        self.slop = Duration(seconds=slop)
        self.queue_offset: Sequence[int] = () if isinstance(queue_offset, bool) else queue_offset
        self.allow_headerless = allow_headerless or queue_offset is True
        self.sync_arrival_time = sync_arrival_time

    def add(self, msg: Any, my_queue: Queue, my_queue_index: int | None = None) -> None:
        """Process a message of one of the filters."""
        time = None if self.sync_arrival_time else self.time_getter(msg)
        if time is None:
            if not (self.allow_headerless or self.sync_arrival_time):
                warn_of_headerless("message_filters_approx")
                return
            time = ROSClock().now()
        if my_queue_index is None:
            my_queue_index = next(index for index, queue in enumerate(self.queues) if queue is my_queue)
        stamp = time.nanoseconds
        if self.queue_offset:
            stamp -= self.queue_offset[my_queue_index]
        with self.lock:
            self._enqueue(stamp, msg, my_queue)
            found = self._partners(stamp, my_queue_index) if stamp in my_queue else None
            if found is None:
                return
            messages = [queue.pop(one) for queue, one in zip(self.queues, found, strict=True)]
        self.signalMessage(*messages)

    def _partners(self, stamp: int, index: int) -> list[int] | None:
        """Return a stamp of every queue for the new one, None when there are none."""
        slop = self.slop.nanoseconds
        candidates = [
            [stamp]
            if number == index
            else sorted((one for one in queue if abs(one - stamp) <= slop), key=lambda one: abs(one - stamp))
            for number, queue in enumerate(self.queues)
        ]
        return _first_combination(candidates, stamp, slop) if all(candidates) else None


def _first_combination(candidates: list[list[int]], stamp: int, slop: int) -> list[int] | None:
    """Return one stamp of every list, all less than `slop` apart: the first in the order of preference.

    Whether a choice leaves one for the lists behind it is found out without trying their combinations, whose number
    grows exponentially.
    """
    ordered = [sorted(one) for one in candidates]
    chosen: list[int] = []
    low = high = stamp
    for place, preferred in enumerate(candidates):
        for one in preferred:
            if _is_possible(ordered[place + 1 :], min(low, one), max(high, one), slop):
                low, high = min(low, one), max(high, one)
                chosen.append(one)
                break
        else:
            return None
    return chosen


def _is_possible(ordered: list[list[int]], low: int, high: int, slop: int) -> bool:
    """Return whether every list has a stamp within a span of less than `slop` that also covers `low` and `high`."""
    begins = {low}.union(*(stamps[bisect_right(stamps, high - slop) : bisect_right(stamps, low)] for stamps in ordered))
    return high - low < slop and any(
        all(_has_between(stamps, begin, begin + slop) for stamps in ordered) for begin in begins
    )


def _has_between(ordered: list[int], begin: int, end: int) -> bool:
    place = bisect_left(ordered, begin)
    return place < len(ordered) and ordered[place] < end
