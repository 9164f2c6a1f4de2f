"""Publishers: snapshots to subscriptions of the same process, bytes to others that are subscribed.

A subscription with a queue gets a snapshot of its own, which its callback may change; those with a sink share one.
"""

from __future__ import annotations

import itertools
import time
from collections import deque
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from daidalos.interfaces.codec import Codec
from daidalos.transport.backend import BackendPublisher
from daidalos.transport.graph import EndpointInfo

if TYPE_CHECKING:
    from daidalos.transport.subscription import Subscription


class Publisher:
    """Publisher of a node, created by `Session.create_publisher`.

    Attributes
    ----------
    endpoint
        How the graph knows it.
    """

    def __init__(self, endpoint: EndpointInfo, codec: Codec) -> None:
        self.endpoint = endpoint
        self._codec = codec
        self._type = codec.message_type
        self._gid = endpoint.gid
        self._next_sequence = itertools.count(1).__next__
        self._matched: dict[Subscription, None] = {}
        self._targets: tuple[Subscription, ...] = ()
        self._remote_subscriptions: set[bytes] = set()
        self._remote: BackendPublisher | None = None
        self._has_remote_subscribers = False
        qos = endpoint.qos
        self._latched = qos.transient_local
        self._history: deque[tuple[Any, ...]] = deque(maxlen=qos.limit if self._latched else 0)
        self._undo: Callable[[], None] | None = None
        self._observers: tuple[Callable[[], None], ...] = ()

    def publish(self, message: Any) -> None:
        """Publish a message, or its CDR bytes, to all subscriptions.

        Raises
        ------
        TypeError
            When `message` is neither of the publisher's type nor bytes.
        CdrError
            When a field holds what its type cannot.
        """
        if message.__class__ is not self._type and not isinstance(message, self._type):
            if not isinstance(message, (bytes, bytearray, memoryview)):
                raise TypeError(f"Expected {self._type}, got {type(message)}")
            self._publish_bytes(bytes(message))
            return
        if self._observers:
            self.note()
        has_remote = self._has_remote_subscribers
        sequence = self._next_sequence()
        if self._targets or has_remote or self._latched:
            stamp = time.time_ns()
            if self._latched:
                self._history.append((self._codec.snapshot(message), stamp, sequence, self._gid))
            snapshot, shared = self._codec.snapshot, None
            for subscription in self._targets:
                if subscription.sink is None:
                    copy = snapshot(message)
                else:
                    copy = shared = snapshot(message) if shared is None else shared
                subscription.accept_local((copy, stamp, sequence, self._gid))
            if has_remote and self._remote is not None:
                self._remote.put(self._codec.parts(message), sequence, stamp)

    def _publish_bytes(self, data: bytes) -> None:
        self.note()
        sequence, stamp = self._next_sequence(), time.time_ns()
        if self._latched:
            self._history.append((self._codec.decode(data), stamp, sequence, self._gid))
        decode, shared = self._codec.decode, None
        for subscription in self._targets:
            if subscription.sink is None:
                message = decode(data)
            else:
                message = shared = decode(data) if shared is None else shared
            subscription.accept_local((message, stamp, sequence, self._gid))
        if self._has_remote_subscribers and self._remote is not None:
            self._remote.put([data], sequence, stamp)

    def observe(self, observer: Callable[[], None]) -> None:
        """Call `observer` at every message and every `note`."""
        self._observers = (*self._observers, observer)

    def note(self) -> None:
        """Assert the publisher's liveliness."""
        for observer in self._observers:
            observer()

    def wait_for_acks(self, timeout_ns: int | None) -> bool:
        """Wait until every reliable subscription has acknowledged all messages; return False on timeout.

        Parameters
        ----------
        timeout_ns
            How long to wait; None for as long as it takes.
        """
        remote = self._remote
        return remote is None or remote.wait_for_acks(timeout_ns)

    @property
    def wire_has_readers(self) -> bool:
        """Whether the middleware itself knows of readers in other processes."""
        return self._remote is not None and self._remote.has_readers

    @property
    def has_subscribers(self) -> bool:
        """Whether a message would be delivered to, or kept for, any subscription."""
        return bool(self._targets) or self._has_remote_subscribers or self._latched

    def replay(self, subscription: Subscription) -> None:
        """Deliver the kept samples to a new subscription of this process."""
        for message, *rest in list(self._history):
            subscription.accept_local((self._codec.snapshot(message), *rest))

    def close(self) -> None:
        """Leave the graph; later messages are discarded."""
        undo, self._undo = self._undo, None
        if undo:
            undo()

    # The session's side.

    def attach(self, remote: BackendPublisher, undo: Callable[[], None]) -> None:
        """Connect to the middleware; `undo` disconnects."""
        self._remote, self._undo = remote, undo
        self.update_remote()

    def add_remote_subscription(self, gid: bytes) -> None:
        """Record a matching subscription of another process."""
        self._remote_subscriptions.add(gid)
        self.update_remote()

    def remove_remote_subscription(self, gid: bytes) -> None:
        """Remove a subscription of another process."""
        self._remote_subscriptions.discard(gid)
        self.update_remote()

    def update_remote(self) -> None:
        """Update whether messages are sent to other processes.

        Where samples are latched, the middleware keeps them for late subscriptions.
        """
        self._has_remote_subscribers = bool(self._remote_subscriptions) or self._latched or self.wire_has_readers

    def add_targets(self, subscriptions: Iterable[Subscription]) -> None:
        """Add subscriptions of this process, which receive every sample."""
        self._matched.update(dict.fromkeys(subscriptions))
        self._targets = tuple(self._matched)

    def remove_target(self, subscription: Subscription) -> None:
        """Remove a subscription of this process, if it is a target."""
        if subscription in self._matched:
            del self._matched[subscription]
            self._targets = tuple(self._matched)

    def detach(self) -> None:
        """Drop the middleware and all subscriptions."""
        remote, self._remote, self._has_remote_subscribers, self._targets = self._remote, None, False, ()
        self._matched.clear()
        if remote:
            remote.close()
