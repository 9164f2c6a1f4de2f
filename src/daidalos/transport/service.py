"""Serving requests: from clients of this process as objects, from others as bytes."""

from __future__ import annotations

import logging
import time
from collections import deque
from collections.abc import Callable
from typing import Any

from daidalos.interfaces.codec import CdrError, Codec
from daidalos.transport.backend import RequestId, WireService
from daidalos.transport.graph import EndpointInfo

_LOGGER = logging.getLogger(__name__)

Reply = Callable[[Any], None]


class Service:
    """One service of a node; made by `Session.create_service`.

    Attributes
    ----------
    endpoint
        How the graph knows it.
    on_ready
        Called after a request was queued, on the thread that queued it.
    """

    def __init__(self, endpoint: EndpointInfo, request: Codec, response: Codec, on_ready: Callable[[], None]) -> None:
        self.endpoint = endpoint
        self.on_ready = on_ready
        self._request = request
        self._response = response
        self._queue: deque[tuple[Any, ...]] = deque()
        self._local: dict[RequestId, Reply] = {}
        self._wire: WireService | None = None
        self._undo: Callable[[], None] | None = None

    def __len__(self) -> int:
        return len(self._queue)

    def take(self) -> tuple[Any, RequestId, int, int] | None:
        """Return the oldest (request, identity, source stamp, reception stamp), or None when there is none.

        A request that cannot be decoded is logged and passed over.
        """
        while True:
            try:
                request, item, received = self._queue.popleft()
            except IndexError:
                return None
            if request is not None:
                return request, item, received, received
            if self._wire is None:
                return None
            try:
                data, identity, stamp = self._wire.request(item)
                return self._request.decode(data), identity, stamp, received
            except CdrError as error:
                _LOGGER.error("dropped a request to '%s': %s", self.endpoint.name, error)

    def reply(self, identity: RequestId, response: Any) -> None:
        """Answer a request that `take` returned.

        Raises
        ------
        CdrError
            When a field of the response holds what its type cannot.
        """
        answer = self._local.pop(identity, None)
        if answer is not None:
            answer(self._response.snapshot(response))
        elif self._wire is not None:
            self._wire.reply(identity, self._response.encode(response))

    def accept_local(self, request: Any, identity: RequestId, answer: Reply) -> None:
        """Queue a request of this process; `answer` takes the response."""
        self._local[identity] = answer
        self._queue.append((self._request.snapshot(request), identity, time.time_ns()))
        self.on_ready()

    def accept(self, item: Any) -> None:
        """Queue a request of another process."""
        self._queue.append((None, item, time.time_ns()))
        self.on_ready()

    def close(self) -> None:
        """Leave the graph and drop what is queued."""
        undo, self._undo = self._undo, None
        if undo:
            undo()

    # The session's side.

    def attach(self, wire: WireService, undo: Callable[[], None]) -> None:
        """Connect to the middleware; `undo` ends that."""
        self._wire, self._undo = wire, undo

    def detach(self) -> None:
        """Forget the middleware and the queue."""
        wire, self._wire = self._wire, None
        self._queue.clear()
        self._local.clear()
        if wire:
            wire.close()
