"""The backend without a wire: everyone in the graph lives in this process."""

from __future__ import annotations

import itertools
import secrets
from collections.abc import Callable
from typing import Any

from daidalos.transport.backend import (
    Backend,
    BackendClient,
    BackendPublisher,
    BackendService,
    BackendSubscription,
    RequestId,
    SampleInfo,
)
from daidalos.transport.graph import EndpointInfo, EndpointKind, Graph, NodeInfo
from daidalos.transport.qos import Qos


class _NullEndpoint(BackendPublisher, BackendSubscription, BackendService, BackendClient):
    """Every kind of wire at once: nothing goes out and nothing comes in."""

    def put(self, parts: list[Any], sequence: int, stamp_ns: int) -> None:
        """Send nothing."""

    def data(self, sample: Any) -> bytes:
        """Return nothing."""
        return b""

    def info(self, sample: Any, received_ns: int) -> SampleInfo:
        """Return what is known of nothing."""
        return SampleInfo(0, received_ns, 0, bytes(16))

    def request(self, item: Any) -> tuple[bytes, RequestId, int]:
        """Return nothing."""
        return b"", RequestId(bytes(16), 0), 0

    def reply(self, request: RequestId, data: bytes) -> None:
        """Answer nobody."""

    def send(self, data: bytes, sequence: int, stamp_ns: int) -> None:
        """Ask nobody."""

    def response(self, item: Any) -> tuple[bytes, int, int]:
        """Return nothing."""
        return b"", 0, 0

    def close(self) -> None:
        """Do nothing."""


class InProcessBackend(Backend):
    """Nodes of one process, cut off from all others: for tests and for lock-step runs."""

    identifier = "rmw_daidalos_inprocess"
    wide = 4

    def __init__(self) -> None:
        self._session = secrets.token_hex(8)
        self._number = itertools.count().__next__

    def start(self, graph: Graph) -> None:
        """Do nothing: nobody else is there."""

    def close(self) -> None:
        """Do nothing."""

    def settle(self, timeout_s: float) -> bool:
        """Return at once."""
        return True

    def identify(
        self, kind: EndpointKind, node: NodeInfo, name: str, type_name: str, type_hash: str, qos: Qos
    ) -> tuple[str, bytes]:
        """Give the endpoint the next number."""
        number = self._number()
        return f"{self._session}/{number}", number.to_bytes(8, "little") + bytes.fromhex(self._session)

    def new_node(self, name: str, namespace: str, enclave: str) -> NodeInfo:
        """Give the node the next number."""
        return NodeInfo(f"{self._session}/{self._number()}", name, namespace, enclave)

    def declare_node(self, node: NodeInfo) -> Callable[[], None]:
        """Tell nobody."""
        return lambda: None

    def declare_publisher(self, key: str, endpoint: EndpointInfo) -> BackendPublisher:
        """Return a wire to nowhere."""
        return _NullEndpoint()

    def declare_subscription(
        self, key: str, endpoint: EndpointInfo, on_sample: Callable[[Any], None]
    ) -> BackendSubscription:
        """Return a wire from nowhere."""
        return _NullEndpoint()

    def declare_service(self, key: str, endpoint: EndpointInfo, on_request: Callable[[Any], None]) -> BackendService:
        """Return a wire from nowhere."""
        return _NullEndpoint()

    def declare_client(self, key: str, endpoint: EndpointInfo, on_response: Callable[[Any], None]) -> BackendClient:
        """Return a wire to nowhere."""
        return _NullEndpoint()
