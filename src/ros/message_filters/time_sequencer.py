"""Passing on messages in the order of their stamps."""

from __future__ import annotations

import heapq
import itertools
import threading
from typing import TYPE_CHECKING, Any

from rclpy.duration import Duration

from .message_traits import get_time_from_message_header
from .simple_filter import SimpleFilter

if TYPE_CHECKING:
    from rclpy.node import Node


class TimeSequencer(SimpleFilter):
    """Filter that holds every message until its stamp is `delay` ago; those that come later are dropped.

    Parameters
    ----------
    f
        The filter to listen to.
    delay
        How long to wait for messages that were overtaken.
    update_rate
        How often to look whether the time of a message has come.
    queue_size
        How many messages may wait; beyond that the oldest is dropped.
    node
        Whose clock and executor to use.
    """

    def __init__(self, f: SimpleFilter, delay: Duration, update_rate: Duration, queue_size: int, node: Node) -> None:
        super().__init__()
        self.delay = delay
        self.queue_size = queue_size
        self._clock = node.get_clock()
        self._waiting: list[tuple[int, int, Any]] = []
        self._last = -1
        self._lock = threading.Lock()
        self._sequence = itertools.count().__next__
        self._timer = node.create_timer(update_rate.nanoseconds / 1e9, self.dispatch, autostart=False)
        self.connectInput(f)

    def connectInput(self, f: SimpleFilter) -> None:
        """Listen to a filter."""
        self.incoming_connection = f.registerCallback(self.add)

    def add(self, msg: Any) -> None:
        """Process a message.

        Raises
        ------
        ValueError
            When it has no stamp.
        """
        time = get_time_from_message_header(msg)
        if time is None:
            raise ValueError(f"a {type(msg).__name__} has no stamp to sort by")
        with self._lock:
            if time.nanoseconds < self._last:
                return
            idle = not self._waiting
            heapq.heappush(self._waiting, (time.nanoseconds, self._sequence(), msg))
            if len(self._waiting) > self.queue_size:
                heapq.heappop(self._waiting)
        if idle:
            self._timer.reset()

    def dispatch(self) -> None:
        """Dispatch the messages whose time has come."""
        due = []
        with self._lock:
            until = self._clock.now().nanoseconds - self.delay.nanoseconds
            while self._waiting and self._waiting[0][0] <= until:
                self._last, _, message = heapq.heappop(self._waiting)
                due.append(message)
            if not self._waiting:
                self._timer.cancel()
        for message in due:
            self.signalMessage(message)
