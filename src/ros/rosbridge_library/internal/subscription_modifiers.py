"""Pace of the messages to one client: at most one in a time, and only the newest of those that wait."""

from __future__ import annotations

import logging
import threading
import time
from collections import deque
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from typing import Any

from daidalos.transport.steady_timers import STEADY_TIMERS, SteadyTimer

_LOGGER = logging.getLogger(__name__)
_THREADS = 2


@cache
def _workers() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(_THREADS, "rosbridge")


class MessageHandler:
    """Handler that passes every message on at once; setting a pace returns the handler for it.

    Parameters
    ----------
    previous_handler
        The handler that this one takes over from; None for the first one.
    publish
        What gets the messages.

    Attributes
    ----------
    throttle_rate : float
        Least time between two messages, in seconds.
    queue_length : int
        How many messages may wait; 0 where none do.
    last_publish : float
        System time of the last message, in seconds.
    """

    def __init__(
        self, previous_handler: MessageHandler | None = None, publish: Callable[[Any], Any] | None = None
    ) -> None:
        self.last_publish: float = getattr(previous_handler, "last_publish", 0.0)
        self.throttle_rate: float = getattr(previous_handler, "throttle_rate", 0.0)
        self.queue_length: int = getattr(previous_handler, "queue_length", 0)
        self.publish: Callable[[Any], Any] | None = getattr(previous_handler, "publish", publish)
        self._last_s: float = getattr(previous_handler, "_last_s", float("-inf"))

    def set_throttle_rate(self, throttle_rate: float) -> MessageHandler:
        """Set the least time between two messages, in milliseconds, and return the handler for it."""
        self.throttle_rate = max(throttle_rate, 0) / 1000.0
        return self.transition()

    def set_queue_length(self, queue_length: int) -> MessageHandler:
        """Set how many messages may wait, and return the handler for it."""
        self.queue_length = max(queue_length, 0)
        return self.transition()

    def time_remaining(self) -> float:
        """Return the time until the next message may be passed on, in seconds."""
        return max(self._last_s + self.throttle_rate - time.monotonic(), 0.0)

    def handle_message(self, msg: Any) -> None:
        """Pass a message on."""
        self.last_publish = time.time()
        self._last_s = time.monotonic()
        if self.publish is not None:
            self.publish(msg)

    def transition(self) -> MessageHandler:
        """Return the handler for the pace that is set, which is this one or takes over from it."""
        kind: type[MessageHandler] = QueueMessageHandler if self.queue_length else ThrottleMessageHandler
        if not self.queue_length and not self.throttle_rate:
            kind = MessageHandler
        if type(self) is kind:
            return self
        self.finish()
        after: MessageHandler = kind(self)
        return after

    def finish(self, block: bool = True) -> None:
        """Pass on no more."""


class ThrottleMessageHandler(MessageHandler):
    """Handler that drops messages that come too early."""

    def handle_message(self, msg: Any) -> None:
        """Pass a message on unless it comes too early."""
        if self.time_remaining() == 0:
            super().handle_message(msg)


class QueueMessageHandler(MessageHandler):
    """Handler whose messages wait, the oldest making room; they are passed on in threads of all such handlers."""

    def __init__(self, previous_handler: MessageHandler, publish: Callable[[Any], Any] | None = None) -> None:
        super().__init__(previous_handler)
        self.queue: deque[Any] = deque(maxlen=self.queue_length)
        self._alive = True
        self._busy = False
        self._timer: SteadyTimer | None = None
        self._changed = threading.Condition()

    def is_alive(self) -> bool:
        """Return whether messages are passed on."""
        return self._alive

    def handle_message(self, msg: Any) -> None:
        """Add a message to those that wait."""
        with self._changed:
            if self._alive:
                self.queue.append(msg)
                self._schedule()

    def transition(self) -> MessageHandler:
        """Return the handler for the pace that is set; messages that wait are kept where it is of this kind."""
        after = super().transition()
        if after is self:
            with self._changed:
                self.queue = deque(self.queue, maxlen=self.queue_length)
                if self._timer is not None:
                    self._timer.cancel()
                    self._timer, self._busy = None, False
                self._schedule()
        return after

    def finish(self, block: bool = True) -> None:
        """Pass on no more; messages that wait are passed on first where there is no least time between them.

        Parameters
        ----------
        block
            Whether to wait for a message that is being passed on.
        """
        with self._changed:
            self._alive = False
            if self._timer is not None:
                self._timer.cancel()
                self._timer, self._busy = None, False
            if block:
                self._changed.wait_for(lambda: not self._busy)
            left = list(self.queue) if not self.throttle_rate else []
            self.queue.clear()
        for msg in left:
            self._pass_on(msg)

    def _schedule(self) -> None:
        if self._busy or not self.queue:
            return
        self._busy = True
        left_s = self.time_remaining()
        if left_s:
            due_ns = time.monotonic_ns() + int(left_s * 1e9) + 1
            self._timer = STEADY_TIMERS.at(due_ns, lambda: self._begin())
        else:
            _workers().submit(self._deliver)

    def _begin(self) -> None:
        with self._changed:
            if self._timer is not None:
                self._timer = None
                _workers().submit(self._deliver)

    def _deliver(self) -> None:
        with self._changed:
            msg = self.queue.popleft() if self._alive and self.queue else None
        if msg is not None:
            self._pass_on(msg)
        with self._changed:
            self._busy = False
            self._changed.notify_all()
            if self._alive:
                self._schedule()

    def _pass_on(self, msg: Any) -> None:
        try:
            super().handle_message(msg)
        except Exception:
            _LOGGER.exception("a message was lost")
