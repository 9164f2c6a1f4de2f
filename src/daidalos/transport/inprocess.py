"""In-process backend, for graphs within a single process."""

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
    """Null endpoint of every type: it neither sends nor receives."""

    def put(self, parts: list[Any], sequence: int, stamp_ns: int) -> None:
        """Send nothing."""

    def data(self, sample: Any) -> bytes:
        """Return nothing."""
        return b""

    def info(self, sample: Any, received_ns: int) -> SampleInfo:
        """Return empty metadata."""
        return SampleInfo(0, received_ns, 0, bytes(16))

    def request(self, item: Any) -> tuple[bytes, RequestId, int]:
        """Return nothing."""
        return b"", RequestId(bytes(16), 0), 0

    def reply(self, request: RequestId, data: bytes) -> None:
        """Do nothing."""

    def send(self, data: bytes, sequence: int, stamp_ns: int) -> None:
        """Do nothing."""

    def response(self, item: Any) -> tuple[bytes, int, int]:
        """Return nothing."""
        return b"", 0, 0

    def close(self) -> None:
        """Do nothing."""


class InProcessBackend(Backend):
    """Nodes of one process without connections to others, for tests and lock-step runs."""

    identifier = "rmw_daidalos_inprocess"
    wide = 4

    def __init__(self) -> None:
        self._session = secrets.token_hex(8)
        self._number = itertools.count().__next__

    def start(self, graph: Graph) -> None:
        """Do nothing; there are no other processes."""

    def close(self) -> None:
        """Do nothing."""

    def settle(self, timeout_s: float) -> bool:
        """Return at once."""
        return True

    def identify(
        self, kind: EndpointKind, node: NodeInfo, name: str, type_name: str, type_hash: str, qos: Qos
    ) -> tuple[str, bytes]:
        """Assign the next number to an endpoint."""
        number = self._number()
        return f"{self._session}/{number}", number.to_bytes(8, "little") + bytes.fromhex(self._session)

    def new_node(self, name: str, namespace: str, enclave: str) -> NodeInfo:
        """Assign the next number to a node."""
        return NodeInfo(f"{self._session}/{self._number()}", name, namespace, enclave)

    def declare_node(self, node: NodeInfo) -> Callable[[], None]:
        """Do nothing."""
        return lambda: None

    def declare_publisher(self, key: str, endpoint: EndpointInfo) -> BackendPublisher:
        """Return a null endpoint."""
        return _NullEndpoint()

    def declare_subscription(
        self, key: str, endpoint: EndpointInfo, on_sample: Callable[[Any], None]
    ) -> BackendSubscription:
        """Return a null endpoint."""
        return _NullEndpoint()

    def declare_service(self, key: str, endpoint: EndpointInfo, on_request: Callable[[Any], None]) -> BackendService:
        """Return a null endpoint."""
        return _NullEndpoint()

    def declare_client(self, key: str, endpoint: EndpointInfo, on_response: Callable[[Any], None]) -> BackendClient:
        """Return a null endpoint."""
        return _NullEndpoint()
