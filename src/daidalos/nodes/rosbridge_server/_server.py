"""Port of the rosbridge protocol, behind the same rules as the studio's."""

from __future__ import annotations

import asyncio
import ssl
import uuid
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from aiohttp import web
from rclpy.node import Node
from rclpy.service import Unanswered
from rosbridge_library.rosbridge_protocol import RosbridgeProtocol

from daidalos.studio.access import Refusal
from daidalos.studio.connections import Connection, Connections
from daidalos.studio.guarded_server import HEARTBEAT_S, LOOPBACK, GuardedServer
from daidalos.studio.outbox import Pieces
from daidalos.studio.stream_client import StreamClient

_REFUSAL_PERIOD_S = 5.0
_LOG_PERIOD_S = 0.1


class ServedProtocol(RosbridgeProtocol):
    """Client of the server, whose faults neither end the node nor fill its log."""

    abandoned = Unanswered

    def _write(self, level: str, text: str) -> None:
        logger = self.node_handle.get_logger()
        if level == "error":
            logger.error(text, throttle_duration_sec=_LOG_PERIOD_S)
        elif level == "warning":
            logger.warning(text, throttle_duration_sec=_LOG_PERIOD_S)
        else:
            logger.debug(text)


class RosbridgeClient(StreamClient):
    """The server's side of one connection of the rosbridge protocol; lives in the server's event loop.

    Parameters
    ----------
    socket, connections, connection, turns, max_text_bytes
        See `StreamClient`.
    protocol
        Carries out the client's messages.
    """

    def __init__(
        self,
        socket: web.WebSocketResponse,
        connections: Connections,
        connection: Connection,
        turns: asyncio.Lock,
        protocol: ServedProtocol,
        max_text_bytes: int,
    ) -> None:
        super().__init__(
            socket, connections, connection, turns, lambda _, __, frame: frame, max_text_bytes=max_text_bytes
        )
        self._protocol = protocol
        self._topics: dict[str, int] = {}
        self._number = 0
        protocol.outgoing = self._put  # type: ignore[method-assign]
        protocol.outgoing_publication = self._put_publication  # type: ignore[method-assign]
        protocol.close_publication = self._close_publication  # type: ignore[method-assign]

    def _put(self, message: str | bytes, compression: str = "none") -> None:
        self.outbox.put_reply(message)

    def _put_publication(self, topic: str, frames: Sequence[str | bytes], compression: str = "none") -> None:
        number = self._topics.get(topic)
        if number is None:
            self._number += 1
            number = self._topics[topic] = self._number
            self.outbox.open(number, latched=False)
        self.outbox.put_message(number, 0, frames[0] if len(frames) == 1 else Pieces(frames))

    def _close_publication(self, topic: str) -> None:
        number = self._topics.pop(topic, None)
        if number is not None:
            self.outbox.close(number)

    async def _receive_text(self, data: str) -> None:
        self._protocol.incoming(data)

    async def _receive_binary(self, data: bytes) -> None:
        self._protocol.incoming(data)  # JSON that a client did not send as text

    def _send_error(self, text: str) -> None:
        self._protocol.log("error", text)

    async def _after_frame(self) -> None:
        if self._protocol.delay_between_messages:
            await asyncio.sleep(self._protocol.delay_between_messages)

    def _release(self) -> None:
        self._protocol.finish()


class RosbridgeServer(GuardedServer):
    """Serves the graph to clients of the rosbridge protocol.

    Parameters
    ----------
    node
        Publishes, subscribes and calls for the clients; it must be spun.
    port
        The port to listen on; 0 for any.
    path
        Path of the address.
    hosts, allowed_hosts, allowed_origins, token, tls
        See `GuardedServer`.
    parameters
        See `RosbridgeProtocol`.
    max_message_bytes
        Bytes of a message of a client.
    compress
        Whether frames are compressed for clients that know how.
    heartbeat_s
        Period in which clients are asked for a sign of life, in seconds.
    clients_changed
        Called in the server's thread with the addresses of the clients by their id, when one comes or leaves.
    """

    def __init__(
        self,
        node: Node,
        *,
        port: int,
        path: str = "/",
        hosts: Sequence[str] = LOOPBACK,
        allowed_hosts: Iterable[str] = (),
        allowed_origins: Iterable[str] = (),
        token: str | None = None,
        tls: ssl.SSLContext | None = None,
        parameters: Mapping[str, Any] | None = None,
        max_message_bytes: int = 10_000_000,
        compress: bool = False,
        heartbeat_s: float = HEARTBEAT_S,
        clients_changed: Callable[[Mapping[str, str]], None] = lambda _: None,
    ) -> None:
        super().__init__(
            port=port,
            hosts=hosts,
            allowed_hosts=allowed_hosts,
            allowed_origins=allowed_origins,
            token=token,
            tls=tls,
            ports_tried=1,
        )
        self._node = node
        self._path = f"/{path.strip('/')}"
        self._parameters = dict(parameters or {})
        self._max_message_bytes = max_message_bytes
        self._compress = compress
        self._heartbeat_s = heartbeat_s
        self._clients_changed = clients_changed
        self._clients: dict[str, str] = {}

    @property
    def address(self) -> str:
        """The address for a client on this machine; with the token, where the server asks for one."""
        return self.url.replace("http", "ws", 1).replace(f":{self.port}/", f":{self.port}{self._path}", 1)

    def _add_routes(self, app: web.Application) -> None:
        for path in {self._path, f"{self._path.rstrip('/')}/"}:
            app.router.add_get(path, self._serve_client)

    def _refused(self, request: web.Request, refusal: Refusal) -> None:
        origin = request.headers.get("Origin")
        hint = "" if origin is None else f" (parameter 'allowed_origins', now without {origin[:100]!r})"
        self._node.get_logger().warning(
            f"refused a client: {refusal.reason}{hint}", throttle_duration_sec=_REFUSAL_PERIOD_S
        )

    async def _serve_client(self, request: web.Request) -> web.StreamResponse:
        if "websocket" not in request.headers.get("Upgrade", "").lower():
            return web.Response(
                status=426,
                text="this port speaks the rosbridge protocol: connect with a WebSocket\n",
                headers={"Upgrade": "websocket"},
            )
        opened, link = await self._open_socket(request, heartbeat_s=self._heartbeat_s, compress=self._compress)
        if link is None:
            return opened
        number = str(uuid.uuid4())
        protocol = ServedProtocol(number, self._node, self._parameters)
        client = RosbridgeClient(opened, self._connections, link, self._turns, protocol, self._max_message_bytes)
        self._clients[number] = request.remote or ""
        self._clients_changed(self._clients)
        try:
            await self._run_client(client, opened)
        finally:
            del self._clients[number]
            self._clients_changed(self._clients)
        return opened
