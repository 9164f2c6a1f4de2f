"""Passing on messages of several inputs in the order of their stamps."""

from __future__ import annotations

import heapq
import itertools
import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rclpy.duration import Duration

from .message_traits import get_time_from_message_header
from .simple_filter import SimpleFilter

if TYPE_CHECKING:
    from rclpy.node import Node


@dataclass
class QueueStatus:
    """State of one input of an `InputAligner`."""

    active: bool
    queue_size: int
    msgs_processed: int
    msgs_dropped: int


class _Input:
    """Messages of one input that wait, and when the next one is expected."""

    def __init__(self) -> None:
        self.waiting: list[tuple[int, int, Any]] = []
        self.output = SimpleFilter()
        self.status = QueueStatus(False, 0, 0, 0)
        self.period_ns = 0
        self._next_ns: int | None = None

    def next_stamp(self) -> int | None:
        """Return the stamp of the oldest message, or of the one that is expected; None when none is."""
        if self.waiting:
            self._next_ns = self.waiting[0][0] + self.period_ns
            self.status.active = True
            return self.waiting[0][0]
        return self._next_ns if self.status.active else None


class InputAligner(SimpleFilter):
    """Aligner of the messages of several filters: each is passed to the callbacks of its own, in the order of stamps.

    A message waits until nothing older can come: until every other input has a newer one, expects its next one
    later (`setInputPeriod`), or has been silent for `timeout`. Messages that come too late are dropped.

    Parameters
    ----------
    timeout
        By how far an input may stay behind the newest stamp until it is not waited for any more.
    filters
        The filters to listen to.
    """

    def __init__(self, timeout: Duration, *filters: SimpleFilter) -> None:
        super().__init__()
        self.timeout = timeout
        self.name = ""
        self.input_connections: list[tuple[SimpleFilter, int]] = []
        self.dispatch_timer: Any = None
        self._inputs: list[_Input] = []
        self._newest_in = self._newest_out = 0
        self._lock = threading.RLock()
        self._sequence = itertools.count().__next__
        if filters:
            self.connectInput(*filters)

    def connectInput(self, *filters: SimpleFilter) -> None:
        """Listen to these filters, and to no others."""
        with self._lock:
            self.disconnectAll()
            self._inputs = [_Input() for _ in filters]
            self.input_connections = [(one, one.registerCallback(self.add, place)) for place, one in enumerate(filters)]

    def disconnectAll(self) -> None:
        """Listen to no filter any more."""
        for one, connection in self.input_connections:
            one.unregisterCallback(connection)
        self.input_connections = []

    def registerCallback(self, index: int, callback: Callable[..., Any], *args: Any) -> int:  # type: ignore[override]
        """Call ``callback(message, *args)`` with the messages of an input, and return the connection."""
        return self._inputs[index].output.registerCallback(callback, *args)

    def setName(self, name: str) -> None:
        """Set the name of the filter."""
        self.name = name

    def getName(self) -> str:
        """Return the filter's name."""
        return self.name

    def setInputPeriod(self, index: int, period: Duration) -> None:
        """Set the period of the stamps of an input."""
        self._inputs[index].period_ns = period.nanoseconds

    def getQueueStatus(self, index: int) -> QueueStatus:
        """Return how an input fares."""
        return self._inputs[index].status

    def add(self, msg: Any, queue_index: int) -> None:
        """Process a message of an input.

        Raises
        ------
        ValueError
            When it has no stamp.
        """
        time = get_time_from_message_header(msg)
        if time is None:
            raise ValueError(f"a {type(msg).__name__} has no stamp to align by")
        stamp = time.nanoseconds
        with self._lock:
            source = self._inputs[queue_index]
            if stamp < self._newest_out:
                source.status.msgs_dropped += 1
                return
            self._newest_in = max(self._newest_in, stamp)
            heapq.heappush(source.waiting, (stamp, self._sequence(), msg))
            source.status.queue_size += 1

    def setupDispatchTimer(self, node: Node, update_rate: Duration) -> None:
        """Create a timer of a node that calls `dispatchMessages`."""
        self.dispatch_timer = node.create_timer(update_rate.nanoseconds / 1e9, self.dispatchMessages)

    def dispatchMessages(self) -> None:
        """Dispatch all messages whose turn has come."""
        with self._lock:
            if any(source.waiting for source in self._inputs):
                while self._dispatch_one():
                    pass

    def _dispatch_one(self) -> bool:
        """Dispatch a message, or give up an input; return False when neither is due."""
        expected = [(stamp, place) for place, one in enumerate(self._inputs) if (stamp := one.next_stamp()) is not None]
        if not expected:
            return False
        stamp, place = min(expected)
        source = self._inputs[place]
        if source.waiting:
            self._newest_out = stamp
            *_, message = heapq.heappop(source.waiting)
            source.status.queue_size -= 1
            source.status.msgs_processed += 1
            source.output.signalMessage(message)
            return True
        if self._newest_in - stamp >= self.timeout.nanoseconds:
            source.status.active = False
            return True
        return False
