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
from daidalos.transport.steady_timers import STEADY_TIMERS

_REPEAT_NS = 10_000_000_000
"""For how long after it was sent a request may be repeated."""


class Client(ServiceEnd[BackendClient, int]):
    """Client of a node, created by `Session.create_client`; responses carry the sequence numbers of their requests.

    A request whose servers have all left the graph without a response, as when the server is restarted, is sent once
    more to the next server that appears within ten seconds.
    """

    incoming = "response of"

    def __init__(self, endpoint: EndpointInfo, request: Codec, response: Codec, on_ready: Callable[[], None]) -> None:
        super().__init__(endpoint, request, response, on_ready)
        self._next_sequence = itertools.count(1).__next__
        self._server: Service | None = None
        self._remote_servers: frozenset[bytes] = frozenset()
        self._unanswered: dict[int, tuple[bytes, frozenset[bytes], int]] = {}

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
            data = self._request.encode(request)
            self._remember(sequence, data)
            self._remote.send(data, sequence, time.time_ns())
        return sequence

    def _remember(self, sequence: int, data: bytes) -> None:
        """Keep a request for as long as it may be repeated."""
        now = time.monotonic_ns()
        for oldest, (_, _, sent) in list(itertools.islice(self._unanswered.items(), 2)):
            if now - sent > _REPEAT_NS:
                self._unanswered.pop(oldest, None)
        if self._remote_servers:
            self._unanswered[sequence] = data, self._remote_servers, now

    def _open(self, remote: BackendClient, item: Any) -> tuple[Any, int, int]:
        data, sequence, stamp = remote.response(item)
        self._unanswered.pop(sequence, None)
        return self._response.decode(data), sequence, stamp

    # The session's side.

    def set_server(self, server: Service | None) -> None:
        """Set the service of this process that answers, or None."""
        self._server = server

    def set_remote_servers(self, gids: frozenset[bytes]) -> None:
        """Set the servers in other processes; they get the unanswered requests whose servers have all gone."""
        self._remote_servers = gids
        if gids and self._unanswered:
            # The middleware, which reports the new server, takes no request meanwhile.
            STEADY_TIMERS.at(time.monotonic_ns(), self._repeat)

    def _repeat(self) -> None:
        remote, servers, now = self._remote, self._remote_servers, time.monotonic_ns()
        if remote is None:
            return
        answered = {remote.response(item)[1] for message, item, _ in self._queue.copy() if message is None}
        for sequence, (data, known, sent) in list(self._unanswered.items()):
            if sequence not in answered and servers.isdisjoint(known) and now - sent <= _REPEAT_NS:
                self._unanswered[sequence] = data, servers, sent
                remote.send(data, sequence, time.time_ns())

    def detach(self) -> None:
        """Drop the middleware, the local service and the queue."""
        self._server = None
        self._unanswered.clear()
        super().detach()
