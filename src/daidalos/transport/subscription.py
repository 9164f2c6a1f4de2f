"""Subscriptions: a queue that receiving threads fill and the executor empties."""

from __future__ import annotations

import logging
import threading
import time
from collections import deque
from collections.abc import Callable
from typing import Any

from daidalos.interfaces.codec import CdrError, Codec
from daidalos.transport.backend import BackendSubscription, SampleInfo
from daidalos.transport.graph import EndpointInfo

_LOGGER = logging.getLogger(__name__)
_TIMEOUT_S = 0.25
_SHORT_TIMEOUT_S = 0.05
_SHORT_FOR_NS = 2_000_000_000
_FAST_NS = 1_000_000
_SLOW_NS = 10 * _FAST_NS

Impairment = Callable[["Subscription", tuple[Any, ...]], None]
"""Imperfect connection: a function of a subscription and a queue entry."""


class Subscription:
    """Subscription of a node, created by `Session.create_subscription`.

    The queue holds samples as they came: ``(message, stamp, sequence, gid)`` from this process, where the
    message is this subscription's own copy, or ``(None, sample, received_ns)`` from another, still encoded.

    Attributes
    ----------
    endpoint
        How the graph knows it.
    on_ready
        Called after a sample was queued, on the thread that queued it.
    queue
        The samples that wait to be taken, the oldest first.
    impairment
        Takes the samples of this process in place of the queue, to pass them on to `enqueue` late or not at all;
        None where the connection is perfect.
    sink
        Takes the messages in place of the queue, at once and on the thread that delivers them; None where they are
        queued. It must not change a message: all sinks of a process get the same one.
    """

    _gave_up_at = -_SHORT_FOR_NS
    """Time at which a subscription of this process last stopped blocking its sender."""

    def __init__(self, endpoint: EndpointInfo, codec: Codec, on_ready: Callable[[], None]) -> None:
        self.endpoint = endpoint
        self.on_ready = on_ready
        self._codec = codec
        self.queue: deque[tuple[Any, ...]] = deque(maxlen=endpoint.qos.limit)
        self._limit = endpoint.qos.limit if endpoint.qos.reliable else None
        self._remote: BackendSubscription | None = None
        self._undo: Callable[[], None] | None = None
        self._refused: set[bytes] = set()
        self._observers: tuple[Callable[[SampleInfo], None], ...] = ()
        self._last_take = 0
        self._take_interval = 0
        self._left_some = False
        self._space = threading.Event()
        self.impairment: Impairment | None = None
        self.sink: Callable[[Any], None] | None = None

    def __len__(self) -> int:
        return len(self.queue)

    def take(self) -> tuple[Any, tuple[Any, ...]] | None:
        """Return the oldest message with its queue entry for `info`; None if the queue is empty.

        A sample that cannot be decoded is logged and passed over.
        """
        while True:
            try:
                item = self.queue.popleft()
            except IndexError:
                return None
            self._note_take()
            if item[0] is not None:
                return item[0], item
            remote = self._remote
            if remote is None:
                return None
            try:
                return self._codec.decode(remote.data(item[1])), item
            except CdrError as error:
                _LOGGER.error("dropped a message on '%s': %s", self.endpoint.name, error)

    def take_raw(self) -> tuple[bytes, tuple[Any, ...]] | None:
        """Return the oldest message as CDR bytes with its queue entry; None if the queue is empty."""
        try:
            item = self.queue.popleft()
        except IndexError:
            return None
        self._note_take()
        if item[0] is not None:
            return self._codec.encode(item[0]), item
        return (self._remote.data(item[1]), item) if self._remote else None

    def info(self, item: tuple[Any, ...]) -> SampleInfo:
        """Return the metadata of a taken sample."""
        remote = self._remote
        if item[0] is not None:
            _, stamp, sequence, gid = item
            return SampleInfo(stamp, stamp, sequence, gid)
        if remote is None:  # closed, by another thread, since the sample was taken
            return SampleInfo(item[2], item[2], 0, bytes(16))
        return remote.info(item[1], item[2])

    def accept_local(self, item: tuple[Any, ...]) -> None:
        """Queue a sample of this process."""
        if self._observers:
            _, stamp, sequence, gid = item
            self._notify(SampleInfo(stamp, stamp, sequence, gid))
        if self.impairment is not None:
            self.impairment(self, item)
        else:
            self.enqueue(item)

    def enqueue(self, item: tuple[Any, ...]) -> None:
        """Queue a sample of this process, past the impairment."""
        if self.sink is not None:
            self.sink(item[0])
            return
        self.queue.append(item)
        self.on_ready()

    def drain_into(self, sink: Callable[[Any], None]) -> None:
        """Set the sink, and pass on what is queued."""
        self.sink = sink
        while (taken := self.take()) is not None:
            sink(taken[0])

    def accept(self, sample: Any, may_wait: bool = True) -> bool:
        """Queue a sample of another process; return False where that would have to wait for room and may not."""
        if not may_wait and self._is_full() and self._take_interval <= _FAST_NS:
            return False
        item = (None, sample, time.time_ns())
        if self._refused or self._observers:
            remote = self._remote
            if remote is None:
                return True
            info = remote.info(sample, item[2])
            if info.gid in self._refused:
                return True
            self._notify(info)
        if self._is_full():
            self._wait_for_space()
        self.queue.append(item)
        if self.sink is not None:
            self.drain_into(self.sink)
        else:
            self.on_ready()
        return True

    def _is_full(self) -> bool:
        """Return whether a reliable subscription's queue is full."""
        return self._limit is not None and len(self.queue) >= self._limit

    def observe(self, observer: Callable[[SampleInfo], None]) -> None:
        """Call `observer` with every sample, on the thread that queues it."""
        self._observers = (*self._observers, observer)

    def _notify(self, info: SampleInfo) -> None:
        for observer in self._observers:
            observer(info)

    def _note_take(self) -> None:
        """Measure how fast the queue is emptied, and wake a waiting receiving thread."""
        if self._limit is None:
            return
        now = time.monotonic_ns()
        if self._left_some:  # a thread that lost its processor once is not slow yet
            self._take_interval += (min(now - self._last_take, _SLOW_NS >> 1) - self._take_interval) >> 3
        self._last_take = now
        self._left_some = bool(self.queue)
        if not self._space.is_set():
            self._space.set()

    def _wait_for_space(self) -> None:
        """Block the sender briefly while the queue is full but is being emptied fast.

        This is what makes a reliable stream lose nothing at full speed, on a busy machine as well, where a thread may
        get no processor for a tenth of a second. A slow callback, however, must not hold up other topics of the same
        peer: then the oldest sample is dropped, as ROS 2 does. Where one callback stalls many topics, all but the
        first are held up for less: zenoh gives up a peer that takes nothing for a second.
        """
        if self._take_interval > _FAST_NS:
            return
        self._space.clear()
        if len(self.queue) < self._limit:  # type: ignore[operator]
            return
        stalled = time.monotonic_ns() - Subscription._gave_up_at < _SHORT_FOR_NS
        if not self._space.wait(_SHORT_TIMEOUT_S if stalled else _TIMEOUT_S):
            self._take_interval = _SLOW_NS
            Subscription._gave_up_at = time.monotonic_ns()

    def close(self) -> None:
        """Leave the graph and drop what is queued."""
        undo, self._undo = self._undo, None
        if undo:
            undo()

    # The session's side.

    def attach(self, remote: BackendSubscription, undo: Callable[[], None]) -> None:
        """Connect to the middleware; `undo` disconnects."""
        self._remote, self._undo = remote, undo

    def refuse(self, gid: bytes) -> None:
        """Reject the samples of a publisher with incompatible QoS."""
        self._refused.add(gid)

    def admit(self, gid: bytes) -> None:
        """Reject the samples of a publisher no longer."""
        self._refused.discard(gid)

    def detach(self) -> None:
        """Drop the middleware and the queue."""
        remote, self._remote = self._remote, None
        self.queue.clear()
        if remote:
            remote.close()
