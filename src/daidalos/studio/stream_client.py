"""One connected WebSocket: its requests come in turn, and its frames wait in an outbox."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import struct
from collections.abc import Callable, Coroutine
from typing import Any, cast

from aiohttp import WSMsgType, web

from daidalos.studio.connections import Connection, Connections
from daidalos.studio.frames import message_frame
from daidalos.studio.limits import MAX_REASON_BYTES, MAX_TEXT_BYTES, Turn
from daidalos.studio.outbox import FrameMaker, Outbox, Pieces

_LOGGER = logging.getLogger(__name__)

_CLOSE_TIMEOUT_S = 0.5
"""Timeout of the closing handshake with a client that is closed for what it did."""
_POLICY_VIOLATION = 1008
_FRAGMENT_BYTES = 256 << 10
"""Bytes of a message that are sent at once: to copy a large one would take the event loop's time from all others."""
_BINARY, _CONTINUATION, _FINAL = 0x2, 0x0, 0x80  # RFC 6455, 5.2


class StreamClient:
    """The server's side of one WebSocket; lives in the server's event loop.

    Subclasses handle the frames, answer errors and release what the client opened.

    Parameters
    ----------
    socket
        The prepared WebSocket.
    connections, connection, turns
        The server's connections, the client's own, and the order of the clients' turns.
    make_frame
        Makes the frame of a subscription's message.
    max_text_bytes
        Bytes of a text frame; a client that sends more is closed.
    """

    def __init__(
        self,
        socket: web.WebSocketResponse,
        connections: Connections,
        connection: Connection,
        turns: asyncio.Lock,
        make_frame: FrameMaker = message_frame,
        max_text_bytes: int | None = None,
    ) -> None:
        self._max_text_bytes = MAX_TEXT_BYTES if max_text_bytes is None else max_text_bytes
        self._socket = socket
        self._connections = connections
        self._connection = connection
        self._turn = Turn(turns)
        self._drained = asyncio.Event()
        self._closing: asyncio.Task[None] | None = None
        self._sending_bytes = 0
        loop = asyncio.get_running_loop()
        self._awake = awake = asyncio.Event()
        self.outbox = Outbox(lambda: _wake(loop, awake), make_frame)  # without a reference to the client: no cycle

    async def run(self) -> None:
        """Receive and send until the connection ends, a limit is passed or the server stops."""
        self._connection.complete()
        self._connection.stream = self
        sender = asyncio.create_task(self._send())
        self._connection.want()
        try:
            async for message in self._socket:
                self._connection.complete()
                async with self._turn:
                    if message.type is WSMsgType.TEXT:
                        await self._receive(self._check_text, message.data)
                    elif message.type is WSMsgType.BINARY:
                        await self._receive(self._receive_binary, message.data)
                if self.outbox.overflowed:
                    self.stop("too many bytes of replies wait to be read")
                if self._closing is not None:
                    break
                self._connection.want()
        finally:
            self._connection.stream = None
            sender.cancel()
            self._release()
            with contextlib.suppress(asyncio.CancelledError):
                await sender
            if self._closing is not None:
                await self._closing

    @property
    def waiting_bytes(self) -> int:
        """Bytes that wait for the client: replies, and what is left of a message that is being sent."""
        return self.outbox.reply_bytes + self._sending_bytes

    def stop(self, reason: str) -> None:
        """Close the connection with a reason, for the client's developer and the log."""
        if self._closing is None:
            self._connections.note_closed(reason)
            self._closing = asyncio.create_task(self._close(reason))

    async def _close(self, reason: str) -> None:
        with contextlib.suppress(TimeoutError, ConnectionError, RuntimeError):
            async with asyncio.timeout(_CLOSE_TIMEOUT_S):
                await self._socket.close(
                    code=_POLICY_VIOLATION, message=reason.encode()[:MAX_REASON_BYTES], drain=False
                )
        transport = self._connection.transport
        if transport is not None:
            transport.abort()  # what it has not read it will not read

    async def _send(self) -> None:
        with contextlib.suppress(ConnectionError):  # the receiving side sees the end as well and closes everything
            while True:
                frame = self.outbox.take()
                if frame is None:
                    self._drained.set()
                    await self._awake.wait()
                    self._awake.clear()
                    continue
                for one in frame.frames if isinstance(frame, Pieces) else (frame,):
                    if isinstance(one, str):
                        await self._socket.send_str(one)
                    elif len(one) <= _FRAGMENT_BYTES:
                        await self._socket.send_bytes(cast(bytes, one))  # it takes a bytearray, too
                    else:
                        await self._send_in_fragments(one)
                    await self._after_frame()

    async def _send_in_fragments(self, message: bytes | bytearray) -> None:
        """Send a binary message in fragments, between which others have their turn (RFC 6455, 5.4)."""
        view = memoryview(message)
        try:
            for begin in range(0, len(view), _FRAGMENT_BYTES):
                if self._socket.closed:
                    raise ConnectionResetError("the WebSocket is closed")
                piece = view[begin : begin + _FRAGMENT_BYTES]
                self._sending_bytes = len(view) - begin - len(piece)
                first = (_CONTINUATION if begin else _BINARY) | (0 if self._sending_bytes else _FINAL)
                await self._connection.write(_head(first, len(piece)) + piece)
        finally:
            self._sending_bytes = 0

    async def _check_text(self, data: str) -> None:
        if len(data) > self._max_text_bytes:
            self.stop(f"a text frame of {len(data)} characters is longer than {self._max_text_bytes}")
        else:
            await self._receive_text(data)

    async def _receive(self, handle: Callable[[Any], Coroutine[Any, Any, None]], data: str | bytes) -> None:
        try:
            await handle(data)
        except Exception as error:  # a fault of ours fails this request, and neither the client nor the server
            _LOGGER.exception("a client's request failed")
            self._send_error(f"the request failed: {type(error).__name__}")

    # What subclasses define --------------------------------------------------------------------------------

    async def _receive_text(self, data: str) -> None:
        """Handle a text frame."""
        raise NotImplementedError

    async def _receive_binary(self, data: bytes) -> None:
        """Handle a binary frame."""
        raise NotImplementedError

    def _send_error(self, text: str) -> None:
        """Answer the request under way with an error."""
        raise NotImplementedError

    def _release(self) -> None:
        """Close what the client opened."""
        raise NotImplementedError

    async def _after_frame(self) -> None:
        """Wait between frames, where the client asks for it."""


def _head(first: int, length: int) -> bytes:
    """Return the head of an unmasked frame, in as few bytes as there can be (RFC 6455, 5.2)."""
    if length < 126:
        return struct.pack(">BB", first, length)
    if length < 1 << 16:
        return struct.pack(">BBH", first, 126, length)
    return struct.pack(">BBQ", first, 127, length)


def _wake(loop: asyncio.AbstractEventLoop, awake: asyncio.Event) -> None:
    with contextlib.suppress(RuntimeError):  # the loop has ended
        loop.call_soon_threadsafe(awake.set)
