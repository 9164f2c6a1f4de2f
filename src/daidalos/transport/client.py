"""Service clients: direct calls within the process, others through the middleware."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable
from typing import Any

from daidalos.interfaces.codec import Codec
from daidalos.transport.backend import BackendClient, RequestId
from daidalos.transport.graph import EndpointInfo
from daidalos.transport.service import Service
from daidalos.transport.service_end import ServiceEnd


class Client(ServiceEnd[BackendClient, int]):
    """Client of a node, created by `Session.create_client`; responses carry the sequence numbers of their requests."""

    incoming = "response of"

    def __init__(self, endpoint: EndpointInfo, request: Codec, response: Codec, on_ready: Callable[[], None]) -> None:
        super().__init__(endpoint, request, response, on_ready)
        self._next_sequence = itertools.count(1).__next__
        self._server: Service | None = None

    @property
    def has_local_server(self) -> bool:
        """Whether the service is served in this process."""
        return self._server is not None

    def send(self, request: Any) -> int:
        """Send a request and return its sequence number.

        Raises
        ------
        TypeError
            When `request` is of the wrong type.
        CdrError
            When a field holds what its type cannot.
        """
        kind = self._request.message_type
        if not isinstance(request, kind):
            raise TypeError(f"Expected {kind}, got {type(request)}")
        sequence = self._next_sequence()
        server = self._server
        if server is not None:
            identity = RequestId(self.endpoint.gid, sequence)
            server.accept_local(request, identity, lambda response: self._accept_local(response, sequence))
        elif self._remote is not None:
            self._remote.send(self._request.encode(request), sequence, time.time_ns())
        return sequence

    def _open(self, remote: BackendClient, item: Any) -> tuple[Any, int, int]:
        data, sequence, stamp = remote.response(item)
        return self._response.decode(data), sequence, stamp

    # The session's side.

    def set_server(self, server: Service | None) -> None:
        """Set the service of this process that answers, or None."""
        self._server = server

    def detach(self) -> None:
        """Drop the middleware, the local service and the queue."""
        self._server = None
        super().detach()
