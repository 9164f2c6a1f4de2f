"""Calling services: in this process directly, elsewhere through the middleware."""

from __future__ import annotations

import itertools
import logging
import time
from collections import deque
from collections.abc import Callable
from typing import Any

from daidalos.interfaces.codec import CdrError, Codec
from daidalos.transport.backend import RequestId, WireClient
from daidalos.transport.graph import EndpointInfo
from daidalos.transport.service import Service

_LOGGER = logging.getLogger(__name__)


class Client:
    """One client of a node; made by `Session.create_client`.

    Attributes
    ----------
    endpoint
        How the graph knows it.
    on_ready
        Called after a response was queued, on the thread that queued it.
    """

    def __init__(self, endpoint: EndpointInfo, request: Codec, response: Codec, on_ready: Callable[[], None]) -> None:
        self.endpoint = endpoint
        self.on_ready = on_ready
        self._request = request
        self._response = response
        self._queue: deque[tuple[Any, ...]] = deque()
        self._next_sequence = itertools.count(1).__next__
        self._server: Service | None = None
        self._wire: WireClient | None = None
        self._undo: Callable[[], None] | None = None

    def __len__(self) -> int:
        return len(self._queue)

    @property
    def has_local_server(self) -> bool:
        """Whether this process serves the service."""
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
        elif self._wire is not None:
            self._wire.send(self._request.encode(request), sequence, time.time_ns())
        return sequence

    def take(self) -> tuple[Any, int, int, int] | None:
        """Return the oldest (response, its request's sequence number, source and reception stamp), or None."""
        while True:
            try:
                response, item, received = self._queue.popleft()
            except IndexError:
                return None
            if response is not None:
                return response, item, received, received
            if self._wire is None:
                return None
            try:
                data, sequence, stamp = self._wire.response(item)
                return self._response.decode(data), sequence, stamp, received
            except CdrError as error:
                _LOGGER.error("dropped a response of '%s': %s", self.endpoint.name, error)

    def _accept_local(self, response: Any, sequence: int) -> None:
        self._queue.append((response, sequence, time.time_ns()))
        self.on_ready()

    def accept(self, item: Any) -> None:
        """Queue a response of another process."""
        self._queue.append((None, item, time.time_ns()))
        self.on_ready()

    def close(self) -> None:
        """Leave the graph and drop what is queued."""
        undo, self._undo = self._undo, None
        if undo:
            undo()

    # The session's side.

    def attach(self, wire: WireClient, undo: Callable[[], None]) -> None:
        """Connect to the middleware; `undo` ends that."""
        self._wire, self._undo = wire, undo

    def set_server(self, server: Service | None) -> None:
        """Note the service of this process that answers, if there is one."""
        self._server = server

    def detach(self) -> None:
        """Forget the middleware and the queue."""
        wire, self._wire, self._server = self._wire, None, None
        self._queue.clear()
        if wire:
            wire.close()
