"""Subscriptions, publications and service calls of the studio's clients, with serialized messages."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any

from rclpy.impl.entities import ClientHandle, PublisherHandle
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

from daidalos.interfaces.codec import codec_of
from daidalos.transport.graph import EndpointInfo

DEPTH = 10
"""Messages that are kept for who is slow."""


class Closing:
    """Opened resource; closing it twice is harmless."""

    def __init__(self, close: Callable[[], None]) -> None:
        self._close: Callable[[], None] | None = close

    def close(self) -> None:
        """Close it."""
        close, self._close = self._close, None
        if close is not None:
            close()


class Publication(Closing):
    """Topic that is published for a client."""

    def __init__(self, handle: PublisherHandle) -> None:
        super().__init__(handle.destroy_when_not_in_use)
        self._impl = handle.impl

    def publish(self, payload: bytes) -> None:
        """Send one message."""
        self._impl.publish(payload)


class Caller:
    """Client of one service with serialized messages."""

    def __init__(self, node: Any, kind: Any, name: str) -> None:
        self._handle = ClientHandle(node, kind, name, QoSProfile(depth=DEPTH))
        self._request = codec_of(kind.Request)
        self._response = codec_of(kind.Response)
        self._waiting: dict[int, Future[bytes]] = {}
        self._lock = threading.Lock()
        self._handle.set_on_ready(self._on_ready)

    def call(self, request: bytes, answer: Future[bytes]) -> None:
        """Send a request; `answer` gets the response."""
        with self._lock:
            self._waiting[self._handle.send_request(self._request.decode(request))] = answer

    def _on_ready(self) -> None:
        taken = self._handle.take_response()
        while taken is not None:
            header, response = taken
            with self._lock:
                answer = self._waiting.pop(header.request_id.sequence_number, None)
            if answer is not None and answer.set_running_or_notify_cancel():  # the client may be gone
                answer.set_result(self._response.encode(response))
            taken = self._handle.take_response()

    def close(self) -> None:
        """Close the client; calls that wait get no answer."""
        self._handle.destroy_when_not_in_use()


def matching_qos(publishers: list[EndpointInfo]) -> QoSProfile:
    """Return a profile that every publisher satisfies."""
    reliable = bool(publishers) and all(one.qos.reliable for one in publishers)
    latched = bool(publishers) and all(one.qos.transient_local for one in publishers)
    return QoSProfile(
        depth=max([DEPTH, *(min(one.qos.depth, 100) for one in publishers)]),
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
    )
