"""Publisher, subscription, service and client over DDS."""

from __future__ import annotations

import ctypes as c
import struct
import threading
import time
from collections.abc import Callable
from typing import Any

from daidalos.interfaces.codec import CdrError
from daidalos.transport.backend import (
    BackendClient,
    BackendPublisher,
    BackendService,
    BackendSubscription,
    RequestId,
    SampleInfo,
)
from daidalos.transport.cyclonedds.library import (
    PUBLICATION_MATCHED_STATUS,
    BuiltinEndpoint,
    Library,
    MatchedStatus,
)
from daidalos.transport.cyclonedds.qos import user_data_of
from daidalos.transport.cyclonedds.reception import Reception, Sample, SampleReader
from daidalos.transport.cyclonedds.writer import Writer

_ENCAPSULATION = 4
_HEADER = struct.Struct("<Qq")
"""Header of requests and replies: the client's number and its request counter."""
_REQUEST_ID = struct.Struct("<QQ")
_CLIENT_TIMEOUT_NS = 100_000_000
_MAX_REACHABLE = 1000
"""Maximum number of remembered clients, alive or not."""


class DdsPublisher(BackendPublisher):
    """Writer of a topic's samples, whose readers DDS reports as soon as it writes to them."""

    def __init__(self, library: Library, reception: Reception, writer: Writer, on_close: Callable[[], None]) -> None:
        self._library = library
        self._reception = reception
        self._writer = writer
        self._on_close = on_close
        self._has_readers = False

    @property
    def has_readers(self) -> bool:
        """Whether DDS has matched a reader of another process."""
        return self._has_readers

    def watch_readers(self, on_change: Callable[[], None]) -> None:
        """Call `on_change` on the receiving thread when `has_readers` has changed."""
        status = MatchedStatus()

        def update() -> None:
            self._library.dds_get_publication_matched_status(self._writer.entity, c.byref(status))
            self._has_readers = status.current_count > 0
            on_change()

        self._reception.add(self._writer.entity, lambda _: update(), PUBLICATION_MATCHED_STATUS)

    def put(self, parts: list[Any], sequence: int, stamp_ns: int) -> None:
        """Send one sample."""
        self._writer.write(parts)

    def wait_for_acks(self, timeout_ns: int | None) -> bool:
        """Wait until all reliable readers have acknowledged what was written; return whether they have."""
        return self._writer.wait_for_acks(timeout_ns)

    def close(self) -> None:
        """Delete the writer."""
        self._on_close()
        self._reception.remove(self._writer.entity)
        self._writer.close()


class DdsSubscription(BackendSubscription):
    """Subscription over DDS; the receiving thread only queues its samples."""

    def __init__(
        self,
        taker: SampleReader,
        reception: Reception,
        reader: int,
        on_sample: Callable[..., bool],
        gid_of: Callable[[int, int], bytes],
        on_close: Callable[[], None],
    ) -> None:
        self._reader = reader
        self._taker = taker
        self._gid_of = gid_of
        self._on_close = on_close

        def offer(sample: Sample) -> bool:
            return on_sample(sample, may_wait=False)

        reception.add(reader, lambda may_wait: taker.take_all(reader, on_sample if may_wait else offer))

    def data(self, sample: Any) -> bytes:
        """Return the sample's bytes."""
        data: bytes = sample.data
        return data

    def info(self, sample: Any, received_ns: int) -> SampleInfo:
        """Return the metadata of a sample; DDS does not number samples."""
        return SampleInfo(sample.source_ns, received_ns, 0, self._gid_of(self._reader, sample.writer))

    def close(self) -> None:
        """Delete the reader."""
        self._on_close()
        self._taker.forget(self._reader)


class DdsService(BackendService):
    """Service over DDS; every client receives every reply and keeps its own."""

    def __init__(
        self,
        library: Library,
        taker: SampleReader,
        reception: Reception,
        reader: int,
        writer: Writer,
        on_request: Callable[[Any], None],
        on_close: Callable[[], None],
    ) -> None:
        self._library = library
        self._reader = reader
        self._writer = writer
        self._on_close = on_close
        self._reachable: set[int] = set()
        self._lock = threading.Lock()
        reception.add(reader, lambda _: taker.take_all(reader, on_request))

    def request(self, item: Any) -> tuple[bytes, RequestId, int]:
        """Return the request's bytes, its identity and its source stamp."""
        client, sequence, data = _split(item.data)
        return data, RequestId(_REQUEST_ID.pack(client, item.writer), sequence), item.source_ns

    def reply(self, request: RequestId, data: bytes) -> None:
        """Send the reply once the client's reader is matched; an unmatched reader would miss it."""
        client, writer = _REQUEST_ID.unpack(request.client)
        with self._lock:
            if writer not in self._reachable and self._wait_for_reader(writer):
                if len(self._reachable) > _MAX_REACHABLE:
                    self._reachable.clear()
                self._reachable.add(writer)
        self._writer.write(_joined(client, request.sequence, data))

    def _wait_for_reader(self, writer: int) -> bool:
        """Wait briefly for the reader of the client that wrote a request; return False if the client is gone."""
        library = self._library
        client = _client_of(library, library.dds_get_matched_publication_data(self._reader, writer))
        if client is None:
            return False
        if not client or self._matches(client):
            return True
        waitset = library.dds_create_waitset(library.dds_get_participant(self._writer.entity))
        library.dds_set_status_mask(self._writer.entity, PUBLICATION_MATCHED_STATUS)
        library.dds_waitset_attach(waitset, self._writer.entity, 0)
        deadline = time.monotonic_ns() + _CLIENT_TIMEOUT_NS
        found = False
        while not (found := self._matches(client)) and (left := deadline - time.monotonic_ns()) > 0:
            library.dds_waitset_wait(waitset, None, 0, left)
            library.dds_get_publication_matched_status(self._writer.entity, None)
        library.dds_delete(waitset)
        return found

    def _matches(self, client: str) -> bool:
        """Return whether the writer of this service is matched with a reader of that client."""
        library, writer = self._library, self._writer.entity
        count = library.dds_get_matched_subscriptions(writer, None, 0)
        handles = (c.c_uint64 * max(count, 1))()
        count = library.dds_get_matched_subscriptions(writer, handles, count)
        return any(
            _client_of(library, library.dds_get_matched_subscription_data(writer, handle)) == client
            for handle in handles[: max(count, 0)]
        )

    def close(self) -> None:
        """Delete reader and writer."""
        self._on_close()
        self._writer.close()


def _client_of(library: Library, endpoint: Any) -> str | None:
    """Return the client in an endpoint's user data, empty if there is no client, None without user data."""
    if not endpoint:
        return None
    found: BuiltinEndpoint = endpoint.contents
    client = user_data_of(library, found.qos).get("clientid", "")
    library.dds_builtintopic_free_endpoint(endpoint)
    return client


class DdsClient(BackendClient):
    """Client over DDS."""

    def __init__(
        self,
        taker: SampleReader,
        reception: Reception,
        reader: int,
        writer: Writer,
        number: int,
        on_response: Callable[[Any], None],
        on_close: Callable[[], None],
    ) -> None:
        self._writer = writer
        self._number = number
        self._on_close = on_close
        mine = number.to_bytes(8, "little")

        def accept(sample: Sample) -> None:
            if sample.data[_ENCAPSULATION : _ENCAPSULATION + 8] == mine:
                on_response(sample)

        reception.add(reader, lambda _: taker.take_all(reader, accept))

    def send(self, data: bytes, sequence: int, stamp_ns: int) -> None:
        """Send one request."""
        self._writer.write(_joined(self._number, sequence, data))

    def response(self, item: Any) -> tuple[bytes, int, int]:
        """Return the response's bytes, its request's sequence number and its source stamp."""
        _, sequence, data = _split(item.data)
        return data, sequence, item.source_ns

    def close(self) -> None:
        """Delete reader and writer."""
        self._on_close()
        self._writer.close()


def _joined(client: int, sequence: int, data: bytes) -> list[Any]:
    return [data[:_ENCAPSULATION], _HEADER.pack(client, sequence), data[_ENCAPSULATION:]]


def _split(data: bytes) -> tuple[int, int, bytes]:
    """Return (client, sequence, message) of a request or reply."""
    if len(data) < _ENCAPSULATION + _HEADER.size:
        raise CdrError(f"{len(data)} bytes are not a request or reply: the header takes {_HEADER.size}")
    client, sequence = _HEADER.unpack_from(data, _ENCAPSULATION)
    return client, sequence, data[:_ENCAPSULATION] + data[_ENCAPSULATION + _HEADER.size :]
