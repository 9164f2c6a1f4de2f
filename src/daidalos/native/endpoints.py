"""Publishers, subscriptions, services and clients of C++ nodes, which carry CDR bytes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rclpy.duration import Duration
from rclpy.impl.entities import (
    ClientHandle,
    EndpointHandle,
    NodeHandle,
    PublisherHandle,
    QueueHandle,
    RequestHeader,
    ServiceHandle,
    SubscriptionHandle,
)
from rclpy.qos import QoSProfile

from daidalos.interfaces.codec import Codec, codec_of
from daidalos.transport.backend import RequestId

BATCH = 64
"""Messages that are taken at a time."""


def profile(values: list[int]) -> QoSProfile:
    """Return a profile from rmw's numbers: history, depth, reliability, durability and so on; durations in ns."""
    history, depth, reliability, durability, deadline, lifespan, liveliness, lease = values
    return QoSProfile(
        history=history,
        depth=depth,
        reliability=reliability,
        durability=durability,
        deadline=Duration(nanoseconds=deadline),
        lifespan=Duration(nanoseconds=lifespan),
        liveliness=liveliness,
        liveliness_lease_duration=Duration(nanoseconds=lease),
    )


class _End:
    """Base of endpoints."""

    _handle: EndpointHandle

    def get_name(self) -> str:
        """Return the full name of the topic or service."""
        return self._handle.name

    def close(self) -> None:
        """Leave the graph."""
        self._handle.destroy_when_not_in_use()


class PublisherEnd(_End):
    """Publisher of encoded messages."""

    _handle: PublisherHandle

    def __init__(self, node: NodeHandle, message_type: Any, topic: str, qos: QoSProfile) -> None:
        self._handle = PublisherHandle(node, message_type, topic, qos)
        self.publish = self._handle.impl.publish

    def count(self) -> int:
        """Return how many subscriptions get the messages."""
        return self._handle.get_subscription_count()

    def assert_liveliness(self) -> None:
        """Assert that the publisher is alive."""
        self._handle.assert_liveliness()

    def wait_for_acks(self, timeout_ns: int) -> bool:
        """Wait until every reliable subscription has all messages; a negative time-out is none."""
        return self._handle.impl.wait_for_acks(timeout_ns if timeout_ns >= 0 else None)


class _QueueEnd(_End):
    """Base of endpoints with a queue; the library is told once until it takes."""

    _handle: QueueHandle

    def __init__(self, handle: QueueHandle, on_ready: Callable[[], None]) -> None:
        self._handle = handle
        self._wake = on_ready
        self._told = False
        handle.set_on_ready(self._tell)

    def _tell(self) -> None:
        if not self._told:
            self._told = True
            self._wake()


class SubscriptionEnd(_QueueEnd):
    """Subscription to encoded messages."""

    _handle: SubscriptionHandle

    def __init__(
        self, node: NodeHandle, message_type: Any, topic: str, qos: QoSProfile, on_ready: Callable[[], None]
    ) -> None:
        super().__init__(SubscriptionHandle(node, message_type, topic, qos), on_ready)

    def count(self) -> int:
        """Return how many publishers send messages."""
        return self._handle.get_publisher_count()

    def take(self) -> list[tuple[bytes, int, int, int, bytes]]:
        """Return the oldest messages with source stamp, reception stamp, sequence number and publisher's gid."""
        self._told = False
        impl = self._handle.impl
        found: list[tuple[bytes, int, int, int, bytes]] = []
        while len(found) < BATCH and (taken := impl.take_raw()) is not None:
            data, item = taken
            found.append((data, *impl.info(item)))
        return found


class ServiceEnd(_QueueEnd):
    """Service with encoded requests and responses."""

    _handle: ServiceHandle

    def __init__(
        self, node: NodeHandle, service_type: Any, name: str, qos: QoSProfile, on_ready: Callable[[], None]
    ) -> None:
        self._request, self._response = _codecs(node, service_type)
        super().__init__(ServiceHandle(node, service_type, name, qos), on_ready)

    def take(self) -> tuple[bytes, bytes, int, bool] | None:
        """Return the oldest request with the client's gid, the number and whether there are more."""
        self._told = False
        taken = self._handle.take_request()
        if taken is None:
            return None
        request, info = taken
        identity = info.request_id.identity
        assert identity is not None
        return self._request.encode(request), identity.client, identity.sequence, len(self._handle.impl) > 0

    def reply(self, client: bytes, sequence: int, response: bytes) -> None:
        """Answer a request."""
        header = RequestHeader(sequence, RequestId(client, sequence))
        self._handle.send_response(self._response.decode(response), header)


class ClientEnd(_QueueEnd):
    """Client with encoded requests and responses."""

    _handle: ClientHandle

    def __init__(
        self, node: NodeHandle, service_type: Any, name: str, qos: QoSProfile, on_ready: Callable[[], None]
    ) -> None:
        self._node = node
        self._request, self._response = _codecs(node, service_type)
        super().__init__(ClientHandle(node, service_type, name, qos), on_ready)

    def ready(self) -> bool:
        """Return whether a server is available."""
        return self._node.session.server_is_ready(self._handle.impl)

    def send(self, request: bytes) -> int:
        """Send a request; return its number."""
        return self._handle.send_request(self._request.decode(request))

    def take(self) -> tuple[bytes, int, bool] | None:
        """Return the oldest response with the number of its request and whether there are more."""
        self._told = False
        taken = self._handle.impl.take()
        if taken is None:
            return None
        response, number, _, _ = taken
        return self._response.encode(response), number, len(self._handle.impl) > 0


def _codecs(node: NodeHandle, service_type: Any) -> tuple[Codec, Codec]:
    """Return the codecs of a service's requests and responses for the node's middleware."""
    wide = node.session.backend.wide
    return codec_of(service_type.Request, wide), codec_of(service_type.Response, wide)
