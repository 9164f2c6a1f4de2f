"""Common base of clients and services: a queue filled by this process and the middleware."""

from __future__ import annotations

import logging
import time
from collections import deque
from collections.abc import Callable
from typing import Any, ClassVar, Generic, TypeVar

from daidalos.interfaces.codec import CdrError, Codec
from daidalos.transport.backend import BackendClient, BackendService
from daidalos.transport.graph import EndpointInfo

_LOGGER = logging.getLogger(__name__)

Remote = TypeVar("Remote", bound=BackendClient | BackendService)
Identity = TypeVar("Identity")


class ServiceEnd(Generic[Remote, Identity]):
    """Client or service whose incoming messages are queued until taken.

    Attributes
    ----------
    endpoint
        How the graph knows it.
    on_ready
        Called after something was queued, on the thread that queued it.
    """

    incoming: ClassVar[str]
    """Description of incoming messages for log messages: ``request to`` or ``response of``."""

    def __init__(self, endpoint: EndpointInfo, request: Codec, response: Codec, on_ready: Callable[[], None]) -> None:
        self.endpoint = endpoint
        self.on_ready = on_ready
        self._request = request
        self._response = response
        self._queue: deque[tuple[Any, Any, int]] = deque()
        self._remote: Remote | None = None
        self._undo: Callable[[], None] | None = None

    def __len__(self) -> int:
        return len(self._queue)

    def take(self) -> tuple[Any, Identity, int, int] | None:
        """Return the oldest (message, identity, source stamp, reception stamp), None if the queue is empty.

        What cannot be decoded is logged and passed over.
        """
        while True:
            try:
                message, item, received = self._queue.popleft()
            except IndexError:
                return None
            if message is not None:
                return message, item, received, received
            if self._remote is None:
                return None
            try:
                message, identity, stamp = self._open(self._remote, item)
            except CdrError as error:
                _LOGGER.error("dropped a %s '%s': %s", self.incoming, self.endpoint.name, error)
            else:
                return message, identity, stamp, received

    def _open(self, remote: Remote, item: Any) -> tuple[Any, Identity, int]:
        """Return the message, its identity and its source stamp of a queued entry."""
        raise NotImplementedError

    def accept(self, item: Any) -> None:
        """Queue a message of another process."""
        self._queue.append((None, item, time.time_ns()))
        self.on_ready()

    def _accept_local(self, message: Any, identity: Identity) -> None:
        """Queue a message of this process."""
        self._queue.append((message, identity, time.time_ns()))
        self.on_ready()

    def close(self) -> None:
        """Leave the graph and drop what is queued."""
        undo, self._undo = self._undo, None
        if undo:
            undo()

    # The session's side.

    def attach(self, remote: Remote, undo: Callable[[], None]) -> None:
        """Connect to the middleware; `undo` disconnects."""
        self._remote, self._undo = remote, undo

    def detach(self) -> None:
        """Drop the middleware and the queue."""
        remote, self._remote = self._remote, None
        self._queue.clear()
        if remote:
            remote.close()
