"""Publisher, subscription, service and client over zenoh."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable
from typing import Any

import zenoh
from zenoh.handlers import Callback

from daidalos.transport.backend import (
    BackendClient,
    BackendPublisher,
    BackendService,
    BackendSubscription,
    RequestId,
    SampleInfo,
)
from daidalos.transport.graph import EndpointInfo
from daidalos.transport.zenoh import attachment
from daidalos.transport.zenoh.pool import SHM_THRESHOLD, Pool
from daidalos.transport.zenoh.threads import on_lasting_thread

_QUERY_TIMEOUT_S = 600.0
_UNLIMITED_S = 10 * 365 * 86400.0


class _ZenohEndpoint:
    """Base of all endpoints: the liveliness token and the zenoh entity to undeclare."""

    on_close: Callable[[], None]

    def __init__(self) -> None:
        # zenoh takes no other call on an entity while one of another thread is under way, and none afterwards.
        # The same thread may come twice: a signal's handler closes what it interrupts.
        self._lock = threading.RLock()
        self._closed = False

    def _close(self, entity: Any) -> None:
        self.on_close()
        with self._lock:
            self._closed = True
            with contextlib.suppress(zenoh.ZError):  # the session may have been closed before
                entity.undeclare()


class ZenohPublisher(_ZenohEndpoint, BackendPublisher):
    """Publisher over zenoh."""

    def __init__(self, session: zenoh.Session, key: str, endpoint: EndpointInfo, pool: Pool) -> None:
        super().__init__()
        self._gid = endpoint.gid
        self._pool = pool
        reliable = endpoint.qos.reliable
        # Reliable means that nothing is lost on the way; best effort never waits.
        self._publisher: Any = session.declare_publisher(
            key,
            congestion_control=zenoh.CongestionControl.BLOCK if reliable else zenoh.CongestionControl.DROP,
            reliability=zenoh.Reliability.RELIABLE if reliable else zenoh.Reliability.BEST_EFFORT,
            allowed_destination=zenoh.Locality.REMOTE,
        )

    def put(self, parts: list[Any], sequence: int, stamp_ns: int) -> None:
        """Send one sample."""
        data = self._pool.place(parts[0] if len(parts) == 1 else b"".join(parts))
        attached = attachment.pack(sequence, stamp_ns, self._gid)
        with self._lock:
            if not self._closed:
                self._publisher.put(data, attachment=attached)

    def close(self) -> None:
        """Undeclare."""
        self._close(self._publisher)


class ZenohSubscription(_ZenohEndpoint, BackendSubscription):
    """Subscription over zenoh; zenoh's thread only queues its samples."""

    def __init__(
        self, session: zenoh.Session, key: str, endpoint: EndpointInfo, on_sample: Callable[[Any], None]
    ) -> None:
        super().__init__()
        self._subscriber: Any = session.declare_subscriber(
            key, Callback(on_lasting_thread(on_sample), indirect=False), allowed_origin=zenoh.Locality.REMOTE
        )

    def data(self, sample: Any) -> bytes:
        """Return the sample's bytes."""
        payload = sample.payload
        # `to_bytes` clears the memory that it then copies to; from shared memory it need not be.
        shared = payload.as_shm() if len(payload) >= SHM_THRESHOLD else None
        data: bytes = payload.to_bytes() if shared is None else bytes(shared)
        return data

    def info(self, sample: Any, received_ns: int) -> SampleInfo:
        """Return the metadata from the attachment."""
        sequence, stamp, gid = attachment.read(sample.attachment)
        return SampleInfo(stamp, received_ns, sequence, gid)

    def close(self) -> None:
        """Undeclare."""
        self._close(self._subscriber)


class ZenohService(_ZenohEndpoint, BackendService):
    """Service over zenoh; a query is held until its reply is sent."""

    def __init__(self, session: zenoh.Session, key: str, on_request: Callable[[Any], None]) -> None:
        super().__init__()
        self._key = key
        self._queries: dict[RequestId, zenoh.Query] = {}
        self._queryable = session.declare_queryable(
            key,
            Callback(on_lasting_thread(on_request), indirect=False),
            complete=True,
            allowed_origin=zenoh.Locality.REMOTE,
        )

    def request(self, item: Any) -> tuple[bytes, RequestId, int]:
        """Return the request's bytes, its identity and its source stamp."""
        sequence, stamp, gid = attachment.read(item.attachment)
        identity = RequestId(gid, sequence)
        self._queries[identity] = item
        payload = item.payload
        return payload.to_bytes() if payload is not None else b"", identity, stamp

    def reply(self, request: RequestId, data: bytes) -> None:
        """Send the reply and drop the query, which signals the end of replies to the client."""
        query = self._queries.pop(request, None)
        if query is None:
            return
        with contextlib.suppress(zenoh.ZError), query:  # the client may be gone
            attached = attachment.pack(request.sequence, _now_ns(), request.client)
            query.reply(self._key, data, attachment=attached)

    def close(self) -> None:
        """Undeclare; pending requests get no reply."""
        self._close(self._queryable)
        self._queries.clear()


class ZenohClient(_ZenohEndpoint, BackendClient):
    """Client over zenoh."""

    def __init__(
        self,
        session: zenoh.Session,
        key: str,
        endpoint: EndpointInfo,
        on_response: Callable[[Any], None],
    ) -> None:
        super().__init__()
        self._gid = endpoint.gid
        self._callback = Callback(on_lasting_thread(on_response), indirect=False)
        waits_for_result = endpoint.name.endswith("/_action/get_result")
        self._querier = session.declare_querier(
            key,
            target=zenoh.QueryTarget.ALL_COMPLETE,
            consolidation=zenoh.ConsolidationMode.NONE,
            timeout=_UNLIMITED_S if waits_for_result else _QUERY_TIMEOUT_S,
            congestion_control=zenoh.CongestionControl.BLOCK,
            allowed_destination=zenoh.Locality.REMOTE,
        )

    def send(self, data: bytes, sequence: int, stamp_ns: int) -> None:
        """Send one request."""
        attached = attachment.pack(sequence, stamp_ns, self._gid)
        with self._lock:
            if not self._closed:
                self._querier.get(self._callback, payload=data, attachment=attached)

    def response(self, item: Any) -> tuple[bytes, int, int]:
        """Return the response's bytes, its request's sequence number and its source stamp."""
        sample = item.ok
        if sample is None:
            return b"", 0, 0
        sequence, stamp, _ = attachment.read(sample.attachment)
        return sample.payload.to_bytes(), sequence, stamp

    def close(self) -> None:
        """Undeclare."""
        self._close(self._querier)


def _now_ns() -> int:
    import time

    return time.time_ns()
