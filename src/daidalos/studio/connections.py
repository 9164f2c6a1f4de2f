"""Connections of the server: how many there are, what they hold, and how long a request may take."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import time
from collections.abc import Callable
from typing import Protocol, cast

from daidalos.studio.limits import (
    HANDSHAKE_S,
    MAX_CONNECTIONS,
    MAX_HELD_BYTES,
    MAX_READ_BYTES,
    MAX_UNFINISHED_BYTES,
    MESSAGE_S,
    PIECE_BYTES,
    STALL_S,
    SWEEP_PERIOD_S,
)

_LOGGER = logging.getLogger(__name__)
_MANY_BYTES = 64 << 10
_LOG_PERIOD_S = 5.0
_LONG_S = 0.0002


class Stream(Protocol):
    """Client on a connection, for `Connections` to close."""

    @property
    def waiting_bytes(self) -> int:
        """Bytes of replies that wait for the client, beside those in the connection's own buffer."""

    def stop(self, reason: str) -> None:
        """Close the connection with a reason."""


class Connection(asyncio.Protocol):
    """Connection of a client, between the socket and the HTTP protocol.

    Attributes
    ----------
    unfinished
        Bytes that were received of a request or message that is not complete.
    stream
        The client, once the connection is a WebSocket.
    """

    def __init__(self, connections: Connections, handler: asyncio.Protocol) -> None:
        self._connections = connections
        self.handler = handler
        self.unfinished = 0
        self.stream: Stream | None = None
        self.transport: asyncio.Transport | None = None
        self._loop = asyncio.get_running_loop()
        self._begun: float | None = self._loop.time()
        self._refusal: tuple[str, str] | None = None
        self._held = 0
        self._moved = self._begun
        self._kept = bytearray()
        self._wants = False
        self._feeding = False
        self._throttled = False
        self._writable = asyncio.Event()
        self._writable.set()

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Implement `asyncio.Protocol`."""
        self.transport = cast(asyncio.Transport, transport)
        if hasattr(transport, "max_size"):
            transport.max_size = MAX_READ_BYTES
        self.handler.connection_made(transport)
        if self._refusal is not None:
            self.refuse(*self._refusal)

    def connection_lost(self, error: Exception | None) -> None:
        """Implement `asyncio.Protocol`."""
        self._connections.remove(self)
        self._writable.set()
        self.handler.connection_lost(error)

    def data_received(self, data: bytes) -> None:
        """Implement `asyncio.Protocol`."""
        if self._begun is None:
            self._begun = self._loop.time()
        self._connections.count(len(data))
        self.unfinished += len(data)
        if self.stream is None:
            self._handle(data)
        else:
            self._kept += data
            self.set_reading()
            self._feed_soon()

    def want(self) -> None:
        """Hand on what was received: the client has handled its messages.

        A WebSocket gets little at a time, since each of its messages that waits costs far more than its bytes.
        """
        self._wants = True
        self._feed_soon()

    def _feed_soon(self) -> None:
        if self._kept and self._wants and not self._feeding:
            self._feeding = True
            self._loop.call_soon(self._feed)

    def _feed(self) -> None:
        self._feeding = False
        if not self._wants or not self._kept or self.transport is None or self.transport.is_closing():
            return
        # A message that is not complete so far is probably a large one.
        size = max(PIECE_BYTES, self.unfinished - len(self._kept))
        piece = bytes(self._kept[:size])
        del self._kept[:size]
        self._handle(piece)
        self.set_reading()
        self._feed_soon()

    def _handle(self, data: bytes) -> None:
        begin = time.perf_counter()
        self.handler.data_received(data)
        used = time.perf_counter() - begin
        if used > _LONG_S:
            self._connections.throttle(self, used)

    def throttle(self, throttled: bool) -> None:
        """Read no more for a while, or again."""
        self._throttled = throttled
        self.set_reading()

    @property
    def is_throttled(self) -> bool:
        """Whether nothing is read for a while."""
        return self._throttled

    def set_reading(self) -> None:
        """Read from the socket unless something speaks against it."""
        transport = self.transport
        if transport is None or transport.is_closing():
            return
        # The WebSocket itself may have stopped reading, until its messages are taken.
        wanted = not (self._kept or self._throttled or getattr(self.handler, "_reading_paused", False))
        if wanted != transport.is_reading():
            transport.resume_reading() if wanted else transport.pause_reading()

    def eof_received(self) -> bool | None:
        """Implement `asyncio.Protocol`."""
        return self.handler.eof_received()

    def pause_writing(self) -> None:
        """Implement `asyncio.Protocol`."""
        self._writable.clear()
        self.handler.pause_writing()

    def resume_writing(self) -> None:
        """Implement `asyncio.Protocol`."""
        self._writable.set()
        self.handler.resume_writing()

    async def write(self, data: bytes) -> None:
        """Send bytes, and wait until the client has read most of them.

        Raises
        ------
        ConnectionResetError
            When the connection is closed or being closed.
        """
        if self.transport is None or self.transport.is_closing():
            raise ConnectionResetError("the connection is closed")
        self.transport.write(data)
        await asyncio.sleep(0)
        await self._writable.wait()

    def complete(self) -> None:
        """Record that a request or message was received as a whole."""
        self._connections.count(len(self._kept) - self.unfinished)
        self.unfinished = len(self._kept)
        self._begun = None
        self._wants = False

    def drop(self) -> None:
        """Forget what was received: the connection is closed."""
        self._kept.clear()
        self.complete()

    def age(self, now: float) -> float:
        """Return for how long a request or message has been incomplete, in seconds."""
        return 0.0 if self._begun is None else now - self._begun

    @property
    def has_asked(self) -> bool:
        """Whether no request is incomplete."""
        return self._begun is None or self.stream is not None

    def held(self) -> int:
        """Return the bytes that wait to be sent."""
        buffered = self.transport.get_write_buffer_size() if self.transport is not None else 0
        return buffered + (self.stream.waiting_bytes if self.stream is not None else 0)

    def stall(self, now: float) -> float:
        """Return for how long the client has read nothing of what waits for it, in seconds."""
        buffered = self.transport.get_write_buffer_size() if self.transport is not None else 0
        if not buffered or buffered != self._held:
            self._held, self._moved = buffered, now
        return now - self._moved

    def refuse(self, status: str, reason: str) -> None:
        """Close the connection with a reason: that of a WebSocket, or an HTTP response."""
        if self.stream is not None:
            self.stream.stop(reason)
        elif self.transport is None:
            self._refusal = (status, reason)
        elif not self.transport.is_closing():
            self.transport.write(_response(status, reason))
            self.transport.close()


class Connections:
    """All connections of a server; lives in its event loop.

    Attributes
    ----------
    room
        Held by who waits for `has_room`, until what there is room for is in place.
    """

    def __init__(self) -> None:
        self.room = asyncio.Lock()
        self._open: dict[asyncio.Protocol, Connection] = {}
        self._unfinished = 0
        self._throttled = 0
        self._closed = 0
        self._logged = -_LOG_PERIOD_S

    def wrap(self, make_handler: Callable[[], asyncio.Protocol]) -> Callable[[], asyncio.Protocol]:
        """Return a function that makes the protocol of a new connection, given what makes that of HTTP."""

        def make() -> asyncio.Protocol:
            if len(self._open) >= MAX_CONNECTIONS and not self._make_room():
                return _Refused(f"{MAX_CONNECTIONS} connections are open already")
            connection = Connection(self, make_handler())
            self.add(connection)  # now: many are accepted before the first one is connected
            return connection

        return make

    def of(self, handler: object) -> Connection | None:
        """Return the connection of an HTTP protocol."""
        return self._open.get(cast(asyncio.Protocol, handler))

    def add(self, connection: Connection) -> None:
        """Count a connection that was accepted."""
        self._open[connection.handler] = connection

    def remove(self, connection: Connection) -> None:
        """Count a connection no longer."""
        connection.drop()
        self._open.pop(connection.handler, None)

    def count(self, received: int) -> None:
        """Count the bytes of incomplete messages; beyond the limit, close the one that began first."""
        self._unfinished += received
        if self._unfinished <= MAX_UNFINISHED_BYTES or received < 0:
            return
        now = asyncio.get_running_loop().time()
        large = [one for one in self._open.values() if one.unfinished > _MANY_BYTES]
        if len(large) > 1:
            oldest = max(large, key=lambda one: one.age(now))
            oldest.refuse("413 Content Too Large", "too many bytes of incomplete messages wait in the server")
            oldest.drop()

    def throttle(self, connection: Connection, used_s: float) -> None:
        """Read no more from a connection for a while, after its data took `used_s` seconds.

        All connections with much data together take a third of the event loop's time.
        """
        if connection.is_throttled:
            return
        self._throttled += 1

        def resume() -> None:
            self._throttled -= 1
            connection.throttle(False)

        connection.throttle(True)
        asyncio.get_running_loop().call_later(2 * used_s * self._throttled, resume)

    def has_room(self) -> bool:
        """Return whether more may be kept for clients to read."""
        return sum(one.held() for one in self._open.values()) < MAX_HELD_BYTES // 2

    def note_closed(self, reason: str) -> None:
        """Log that a client was closed, and how many were since the last time."""
        self._closed += 1
        now = asyncio.get_running_loop().time()
        if now - self._logged >= _LOG_PERIOD_S:
            _LOGGER.warning("closed %d client(s), the last one because %s", self._closed, reason)
            self._closed, self._logged = 0, now

    async def sweep(self) -> None:
        """Close connections that take too long or hold too much, for as long as the server runs."""
        while True:
            await asyncio.sleep(SWEEP_PERIOD_S)
            self.check(asyncio.get_running_loop().time())

    def check(self, now: float) -> None:
        """Close the connections that take too long or hold too much."""
        held: list[tuple[float, int, Connection]] = []
        for one in tuple(self._open.values()):
            stall = one.stall(now)
            if one.transport is None and one.age(now) > 2 * HANDSHAKE_S:
                self.remove(one)  # its TLS handshake failed
            elif not one.has_asked and one.age(now) > HANDSHAKE_S:
                one.refuse("408 Request Timeout", f"no complete request in {HANDSHAKE_S:g} s")
            elif one.stream is not None and one.age(now) > MESSAGE_S:
                one.refuse("", f"a message was not complete after {MESSAGE_S:g} s")
            elif one.stream is not None and stall > STALL_S:
                one.refuse("", f"nothing was read for {STALL_S:g} s")
            else:
                held.append((stall, one.held(), one))
        total = sum(size for _, size, _ in held)
        for _, size, one in sorted(held, key=lambda entry: (entry[0] + SWEEP_PERIOD_S) * entry[1], reverse=True):
            if total <= MAX_HELD_BYTES or not size:
                break
            one.refuse("", "too many bytes wait to be read")
            total -= size

    def _make_room(self) -> bool:
        """Close the oldest connection without a complete request; return whether there was one."""
        now = asyncio.get_running_loop().time()
        waiting = [one for one in self._open.values() if not one.has_asked]
        if not waiting:
            return False
        oldest = max(waiting, key=lambda one: one.age(now))
        oldest.refuse("503 Service Unavailable", "too many connections are open")
        self.remove(oldest)
        return True


class _Refused(asyncio.Protocol):
    """Connection that is closed at once."""

    def __init__(self, reason: str) -> None:
        self._reason = reason

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        with contextlib.suppress(OSError):
            cast(asyncio.Transport, transport).write(_response("503 Service Unavailable", self._reason))
        transport.close()


def _response(status: str, reason: str) -> bytes:
    body = f"{reason}\n".encode()
    head = f"HTTP/1.1 {status}\r\nContent-Type: text/plain\r\nContent-Length: {len(body)}\r\nConnection: close\r\n\r\n"
    return head.encode() + body
