"""Service servers: requests of this process as objects, others as bytes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from daidalos.interfaces.codec import Codec
from daidalos.transport.backend import BackendService, RequestId
from daidalos.transport.graph import EndpointInfo
from daidalos.transport.service_end import ServiceEnd

Reply = Callable[[Any], None]


class Service(ServiceEnd[BackendService, RequestId]):
    """Service of a node, created by `Session.create_service`."""

    incoming = "request to"

    def __init__(self, endpoint: EndpointInfo, request: Codec, response: Codec, on_ready: Callable[[], None]) -> None:
        super().__init__(endpoint, request, response, on_ready)
        self._local: dict[RequestId, Reply] = {}

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
        elif self._remote is not None:
            self._remote.reply(identity, self._response.encode(response))

    def accept_local(self, request: Any, identity: RequestId, answer: Reply) -> None:
        """Queue a request of this process; `answer` receives the response."""
        self._local[identity] = answer
        self._accept_local(self._request.snapshot(request), identity)

    def _open(self, remote: BackendService, item: Any) -> tuple[Any, RequestId, int]:
        data, identity, stamp = remote.request(item)
        return self._request.decode(data), identity, stamp

    # The session's side.

    def detach(self) -> None:
        """Drop the middleware, the queue and the local requests."""
        super().detach()
        self._local.clear()
