"""The queue of frames to one client: replies in order, and of each subscription only the newest messages.

A client that reads slowly must neither delay publishers nor fill the memory. Each subscription therefore keeps a few
of its newest messages, and the subscriptions are served in turn; the dropped message is always the oldest of the
same topic. More small messages are kept: transforms, log lines and values of curves do not replace each other.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from daidalos.studio.frames import message_frame, time_frame


@dataclass(frozen=True)
class Pieces:
    """Message of several frames, which are sent or left out together."""

    frames: Sequence[str | bytes]

    def __len__(self) -> int:
        return sum(map(len, self.frames))


Content = str | bytes | Pieces
FrameMaker = Callable[[int, int, Any], str | bytes | bytearray | Pieces]
"""Function that makes a frame, or several, of a subscription's number, a time [ns] and what was put."""
BACKLOG = 16
"""Messages that wait per subscription; more only adds latency to a client that is late already."""
LIGHT_BYTES = 64 << 10
"""Messages are small as long as all of a subscription that wait have no more bytes."""
LONG_BACKLOG = 1024
"""Small messages that wait per subscription, and latched ones: these hold state, not a stream, and many
publishers of /tf_static each send one at once."""
MESSAGE_BYTES = 64 << 20
"""Bytes of messages that wait per client; beyond, the largest queue loses its oldest."""
REPLY_BYTES = 16 << 20
"""Bytes of replies that wait, beside the last one, before a client that does not read them is disconnected."""


class Outbox:
    """The frames of one client; `put_message` may be called from any thread.

    Parameters
    ----------
    wake
        Called, from any thread, when there is something to take after there was nothing.
    make_frame
        Makes the frame of a message.
    """

    def __init__(self, wake: Callable[[], None], make_frame: FrameMaker = message_frame) -> None:
        self._wake = wake
        self._make_frame = make_frame
        self._lock = threading.Lock()
        self._replies: deque[str | bytes | bytearray] = deque()
        self._reply_bytes = 0
        self._queues: dict[int, _Queue] = {}
        self._turns: deque[_Queue] = deque()
        self._message_bytes = 0
        self._time: int | None = None
        self._sleeping = True
        self.dropped = 0

    @property
    def overflowed(self) -> bool:
        """Whether too many bytes of replies wait: the client does not read them."""
        with self._lock:
            last = len(self._replies[-1]) if self._replies else 0
            return self._reply_bytes - last > REPLY_BYTES

    @property
    def reply_bytes(self) -> int:
        """Bytes of replies that wait."""
        return self._reply_bytes

    def open(self, subscription: int, latched: bool) -> None:
        """Add the queue of a subscription."""
        with self._lock:
            self._queues[subscription] = _Queue(subscription, LONG_BACKLOG if latched else BACKLOG)

    def close(self, subscription: int) -> None:
        """Remove the queue of a subscription with its messages."""
        with self._lock:
            queue = self._queues.pop(subscription, None)
            if queue is not None:
                self._message_bytes -= queue.bytes
                queue.clear()

    def put_message(self, subscription: int, nanoseconds: int, payload: Content) -> None:
        """Add a message; unknown subscriptions have just been closed and are ignored."""
        with self._lock:
            queue = self._queues.get(subscription)
            if queue is None:
                return
            if not queue.waiting:
                self._turns.append(queue)
            self._message_bytes += queue.push(nanoseconds, payload)
            if len(queue.waiting) > (queue.limit if queue.bytes > LIGHT_BYTES else LONG_BACKLOG):
                self._drop_oldest(queue)
            while self._message_bytes > MESSAGE_BYTES:
                largest = max(self._queues.values(), key=_Queue.spare_bytes)
                if not largest.spare_bytes():
                    break
                self._drop_oldest(largest)
            woken = self._wake_up()
        if woken:
            self._wake()

    def put_reply(self, frame: str | bytes | bytearray) -> None:
        """Add a reply or an announcement; replies go before messages and none is dropped."""
        with self._lock:
            self._replies.append(frame)
            self._reply_bytes += len(frame)
            woken = self._wake_up()
        if woken:
            self._wake()

    def put_time(self, nanoseconds: int) -> None:
        """Set the time to send next; only the newest is sent."""
        with self._lock:
            self._time = nanoseconds
            woken = self._wake_up()
        if woken:
            self._wake()

    def take(self) -> str | bytes | bytearray | Pieces | None:
        """Remove and return the next frame; None when nothing waits, and the next arrival will wake."""
        with self._lock:
            if self._replies:
                frame = self._replies.popleft()
                self._reply_bytes -= len(frame)
                return frame
            if self._time is not None:
                nanoseconds, self._time = self._time, None
                return time_frame(nanoseconds)
            while self._turns:
                queue = self._turns.popleft()
                if not queue.waiting:
                    continue  # closed in the meantime
                nanoseconds, payload = queue.pop()
                self._message_bytes -= len(payload)
                if queue.waiting:
                    self._turns.append(queue)
                return self._make_frame(queue.subscription, nanoseconds, payload)
            self._sleeping = True
            return None

    def _drop_oldest(self, queue: _Queue) -> None:
        _, payload = queue.pop()
        self._message_bytes -= len(payload)
        self.dropped += 1

    def _wake_up(self) -> bool:
        woken, self._sleeping = self._sleeping, False
        return woken


class _Queue:
    """The messages of one subscription that wait."""

    __slots__ = ("bytes", "limit", "subscription", "waiting")

    def __init__(self, subscription: int, limit: int) -> None:
        self.subscription = subscription
        self.limit = limit
        self.waiting: deque[tuple[int, Content]] = deque()
        self.bytes = 0

    def push(self, nanoseconds: int, payload: Content) -> int:
        self.waiting.append((nanoseconds, payload))
        self.bytes += len(payload)
        return len(payload)

    def pop(self) -> tuple[int, Content]:
        oldest = self.waiting.popleft()
        self.bytes -= len(oldest[1])
        return oldest

    def clear(self) -> None:
        self.waiting.clear()
        self.bytes = 0

    def spare_bytes(self) -> int:
        """Return the bytes that may be dropped: all but the newest message."""
        return self.bytes - len(self.waiting[-1][1]) if len(self.waiting) > 1 else 0
