"""The studio's server: the page and the Foxglove WebSocket protocol on one port, in a thread of its own."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import socket
import ssl
import threading
import uuid
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import Future
from pathlib import Path

from aiohttp import web
from aiohttp.http_exceptions import HttpProcessingError
from aiohttp.typedefs import Handler

from daidalos.studio import protocol
from daidalos.studio.access import (
    TOKEN_QUERY,
    AccessPolicy,
    Refusal,
    entrance,
    identify,
    new_token,
    too_long,
)
from daidalos.studio.arrangement import Arrangement
from daidalos.studio.assets import AssetResolver
from daidalos.studio.client import Client
from daidalos.studio.connections import Connections
from daidalos.studio.files import STATIC
from daidalos.studio.hub import Changes, Hub
from daidalos.studio.layouts import MAX_FILE_BYTES, read_layout, write_layout
from daidalos.studio.limits import HANDSHAKE_S
from daidalos.studio.local_users import is_of_another_user
from daidalos.studio.pages import (
    ARRANGEMENT_KEY,
    HEADERS,
    STATIC_KEY,
    arrangement_of,
    extension_module,
    extensions_of,
    page,
)
from daidalos.studio.ports import ACCEPTED_AT_ONCE, ANY_ADDRESS, BACKLOG, is_loopback, open_port, outward_address
from daidalos.studio.protocol import Level
from daidalos.studio.source import GraphSource, Parameter, Topic

DEFAULT_PORT = 8765
LOOPBACK = ("127.0.0.1", "::1")
MAX_FRAME_BYTES = 64 << 20  # what a client may send at once; a published image or cloud fits
REFRESH_DELAY_S = 0.05  # a graph changes in bursts when nodes start
TIME_PERIOD_S = 1 / 60  # a screen shows no more
CLOSE_TIMEOUT_S = 0.3
KEEP_ALIVE_S = 30.0


def _is_own_fault(record: logging.LogRecord) -> bool:
    """Return whether an error of HTTP is not the client's, who could fill the log with what is not HTTP."""
    return not (record.exc_info and isinstance(record.exc_info[1], HttpProcessingError | ConnectionError))


_HTTP_LOGGER = logging.getLogger(f"{__name__}.http")
_HTTP_LOGGER.addFilter(_is_own_fault)


class StudioServer:
    """Serves a graph to browsers and to any client of the Foxglove WebSocket protocol.

    Parameters
    ----------
    source
        The graph.
    name
        What clients show as the name of the connection.
    port
        The port to listen on, or the next free one above; 0 for any.
    hosts
        Addresses to listen on; loopback unless told otherwise.
    allowed_hosts, allowed_origins
        See `AccessPolicy`.
    assets
        Finds meshes and textures; None serves none.
    static
        Folder of the built page.
    metadata
        What else clients are told, e.g. ``{"ROS_DISTRO": "jazzy"}``.
    arrangement
        The layout with which the page opens; None: the page's default.
    token
        What clients must send; None: nothing where the server listens on loopback, else a random one.
    tls
        Certificate and key; None: connections are not encrypted.
    """

    def __init__(
        self,
        source: GraphSource,
        *,
        name: str = "daidalos",
        port: int = DEFAULT_PORT,
        hosts: Sequence[str] = LOOPBACK,
        allowed_hosts: Iterable[str] = (),
        allowed_origins: Iterable[str] = (),
        assets: AssetResolver | None = None,
        static: Path = STATIC,
        metadata: Mapping[str, str] | None = None,
        arrangement: Arrangement | None = None,
        token: str | None = None,
        tls: ssl.SSLContext | None = None,
    ) -> None:
        self._source = source
        self._name = name
        self._wanted_port = port
        self._hosts = tuple(hosts)
        if token is None and not all(map(is_loopback, self._hosts)):
            token = new_token()
        self._token = token
        self._tls = tls
        self._access = AccessPolicy(allowed_hosts, allowed_origins, token)
        self._assets = assets
        self._static = static
        self._metadata = dict(metadata or {})
        self._arrangement = arrangement
        self._session = uuid.uuid4().hex
        self._hub = Hub(source)
        self._connections = Connections()
        self._turns = asyncio.Lock()
        self._clients: set[Client] = set()
        self._sockets: set[web.WebSocketResponse] = set()
        self._refresh_pending = False
        self._time: int | None = None
        self._time_pending = False
        self._thread: threading.Thread | None = None
        self._loop: asyncio.AbstractEventLoop | None = None
        self._stopping: asyncio.Event | None = None
        self._port = 0

    @property
    def port(self) -> int:
        """The port that was opened; 0 before `start`."""
        return self._port

    @property
    def url(self) -> str:
        """The page's address for a browser on this machine; with the token, where the server asks for one."""
        local = any(is_loopback(host) or host in ANY_ADDRESS for host in self._hosts)
        return self._address("localhost" if local else self._hosts[0])

    @property
    def remote_url(self) -> str | None:
        """The page's address for other machines; None where they cannot reach it."""
        if all(map(is_loopback, self._hosts)):
            return None
        host = next(host for host in self._hosts if not is_loopback(host))
        return self._address(outward_address() if host in ANY_ADDRESS else host)

    @property
    def asks_for_token(self) -> bool:
        """Whether clients must send a token."""
        return self._token is not None

    @property
    def is_encrypted(self) -> bool:
        """Whether connections are encrypted."""
        return self._tls is not None

    def _address(self, host: str) -> str:
        name = f"[{host}]" if ":" in host else host
        query = f"?{TOKEN_QUERY}={self._token}" if self._token else ""
        return f"{'https' if self._tls else 'http'}://{name}:{self._port}/{query}"

    @property
    def client_count(self) -> int:
        """How many clients are connected."""
        return len(self._clients)

    def start(self) -> None:
        """Open the port and serve from a new thread; returns when clients can connect.

        Raises
        ------
        PortError
            When the address cannot be opened, or no port is free.
        """
        sockets = open_port(self._hosts, self._wanted_port)
        self._port = sockets[0].getsockname()[1]
        ready: Future[None] = Future()
        self._thread = threading.Thread(target=self._run, args=(sockets, ready), name="studio", daemon=True)
        self._thread.start()
        ready.result()

    def stop(self) -> None:
        """Close the connections and the port, and end the thread; within a second."""
        thread, self._thread = self._thread, None
        if thread is not None:
            self._soon(self._request_stop)
            thread.join()

    def __enter__(self) -> StudioServer:
        self.start()
        return self

    def __exit__(self, *exception: object) -> None:
        self.stop()

    # What the source calls, from any thread ---------------------------------------------------------------

    def graph_changed(self) -> None:
        """Implement `Observer`."""
        self._soon(self._schedule_refresh)

    def time_advanced(self, nanoseconds: int) -> None:
        """Implement `Observer`."""
        first, self._time = self._time is None, nanoseconds
        if first:
            self._soon(self._announce_time)
        if not self._time_pending:
            self._time_pending = True
            self._soon(self._schedule_time)

    def parameters_changed(self, parameters: Sequence[Parameter]) -> None:
        """Implement `Observer`."""
        self._soon(lambda: self._send_parameters(parameters))

    def _soon(self, call: Callable[[], object]) -> None:
        loop = self._loop
        if loop is not None:
            with contextlib.suppress(RuntimeError):  # the loop has ended, and every client with it
                loop.call_soon_threadsafe(call)

    # The server's thread ----------------------------------------------------------------------------------

    def _run(self, sockets: list[socket.socket], ready: Future[None]) -> None:
        try:
            asyncio.run(self._serve(sockets, ready))
        except BaseException as error:
            if ready.done():
                raise
            ready.set_exception(error)

    async def _serve(self, sockets: list[socket.socket], ready: Future[None]) -> None:
        self._loop = asyncio.get_running_loop()
        self._stopping = asyncio.Event()
        app = web.Application(middlewares=[self._guard], client_max_size=MAX_FILE_BYTES)
        app[STATIC_KEY] = self._static
        app[ARRANGEMENT_KEY] = self._arrangement
        app.router.add_get("/", self._root)
        app.router.add_get("/arrangement.json", arrangement_of)
        app.router.add_post("/layouts/read", read_layout)
        app.router.add_post("/layouts/rviz", write_layout)
        app.router.add_get("/extensions.json", extensions_of)
        app.router.add_get("/extensions/{kind}/{name}/{path:.*}", extension_module)
        app.router.add_get("/{path:.*}", page)
        runner = web.AppRunner(
            app,
            access_log=None,
            handle_signals=False,
            shutdown_timeout=CLOSE_TIMEOUT_S,
            keepalive_timeout=KEEP_ALIVE_S,
            logger=_HTTP_LOGGER,
        )
        observing = None
        listeners: list[asyncio.Server] = []
        sweep = asyncio.create_task(self._connections.sweep())
        try:
            await runner.setup()
            assert runner.server is not None
            make_protocol = self._connections.wrap(runner.server)
            timeout = None if self._tls is None else HANDSHAKE_S
            for opened in sockets:
                listener = await self._loop.create_server(
                    make_protocol, sock=opened, backlog=ACCEPTED_AT_ONCE, ssl=self._tls, ssl_handshake_timeout=timeout
                )
                opened.listen(BACKLOG)  # those that are not accepted at once wait in the system
                listeners.append(listener)
            self._time = self._source.time()
            observing = self._source.attach(self)
            self._hub.refresh()
            ready.set_result(None)
            await self._stopping.wait()
        finally:
            if observing is not None:
                observing.close()
            sweep.cancel()
            for listener in listeners:
                listener.close()
            await self._close_connections()
            await runner.cleanup()
            self._loop = None

    def _request_stop(self) -> None:
        if self._stopping is not None:
            self._stopping.set()

    async def _close_connections(self) -> None:
        closing = [asyncio.create_task(each.close(code=1001)) for each in self._sockets]
        if closing:
            _, late = await asyncio.wait(closing, timeout=CLOSE_TIMEOUT_S)
            for task in late:
                task.cancel()

    @web.middleware
    async def _guard(self, request: web.Request, handler: Handler) -> web.StreamResponse:
        connection = self._connections.of(request.protocol)
        if connection is not None:
            connection.complete()
        refusal = too_long(request) or self._access.refusal(identify(request, self._port)) or self._other_user(request)
        if refusal is not None:
            return web.Response(status=refusal.status, text=refusal.reason + "\n", headers=HEADERS)
        return (entrance(request, self._port) if self._token else None) or await handler(request)

    def _other_user(self, request: web.Request) -> Refusal | None:
        """Return the refusal of a connection by another user of this machine, where no token is asked for."""
        ends = [request.get_extra_info(name) for name in ("peername", "sockname")]
        if self._token is not None or None in ends or not is_of_another_user(*ends):
            return None
        return Refusal(403, "this server is another user's; it serves others only where it is started with a token")

    async def _root(self, request: web.Request) -> web.StreamResponse:
        if "websocket" not in request.headers.get("Upgrade", "").lower():
            return await page(request)
        return await self._serve_client(request)

    async def _serve_client(self, request: web.Request) -> web.StreamResponse:
        offered = {name.strip() for name in request.headers.get("Sec-WebSocket-Protocol", "").split(",")}
        if not offered & set(protocol.SUBPROTOCOLS):
            known = " or ".join(protocol.SUBPROTOCOLS)
            return web.Response(status=400, text=f"expected the WebSocket subprotocol {known}\n")
        connection = web.WebSocketResponse(
            protocols=protocol.SUBPROTOCOLS,
            compress=False,  # costs more than loopback and local networks give back
            heartbeat=30,
            max_msg_size=MAX_FRAME_BYTES,
            timeout=CLOSE_TIMEOUT_S,
        )
        await connection.prepare(request)
        link = self._connections.of(request.protocol)
        if link is None:
            return connection  # it was lost meanwhile
        client = Client(connection, self._source, self._hub, self._assets, self._connections, link, self._turns)
        for frame in self._first_frames():
            client.outbox.put_reply(frame)
        if self._time is not None:
            client.outbox.put_time(self._time)
        self._clients.add(client)
        self._sockets.add(connection)
        try:
            await client.run()
        finally:
            self._clients.discard(client)
            self._sockets.discard(connection)
        return connection

    def _first_frames(self) -> list[str]:
        frames = [self._server_info()]
        if self._hub.topics:
            frames += _announce(self._hub.topics)
        if self._hub.services:
            frames.append(protocol.advertise_services(self._hub.services))
        return frames

    def _server_info(self) -> str:
        return protocol.server_info(self._name, self._session, self._time is not None, self._metadata)

    def _schedule_refresh(self) -> None:
        if not self._refresh_pending:
            self._refresh_pending = True
            asyncio.get_running_loop().call_later(REFRESH_DELAY_S, self._refresh)

    def _refresh(self) -> None:
        self._refresh_pending = False
        changes = self._hub.refresh()
        graph = self._source.graph()
        frames = _changes(changes)
        for client in self._clients:
            client.channels_gone(set(changes.topics_gone))
            for frame in frames:
                client.outbox.put_reply(frame)
            client.graph_changed(graph)

    def _send_parameters(self, parameters: Sequence[Parameter]) -> None:
        for client in self._clients:
            client.parameters_changed(parameters)

    def _announce_time(self) -> None:
        # The same session with one capability more: clients keep what they have.
        for client in self._clients:
            client.outbox.put_reply(self._server_info())

    def _schedule_time(self) -> None:
        asyncio.get_running_loop().call_later(TIME_PERIOD_S, self._send_time)

    def _send_time(self) -> None:
        self._time_pending = False
        if self._time is not None:
            for client in self._clients:
                client.outbox.put_time(self._time)


def _changes(changes: Changes) -> list[str]:
    frames = []
    if changes.topics_gone:
        frames.append(protocol.Unadvertise(tuple(changes.topics_gone)).encode())
        unknown = _without_definition(changes.topics_gone)
        if unknown:
            frames.append(protocol.RemoveStatus(tuple(map(_definition_status, unknown))).encode())
    if changes.services_gone:
        frames.append(protocol.UnadvertiseServices(tuple(changes.services_gone)).encode())
    if changes.topics:
        frames += _announce(changes.topics)
    if changes.services:
        frames.append(protocol.advertise_services(changes.services))
    return frames


def _announce(topics: Mapping[int, Topic]) -> list[str]:
    statuses = [
        protocol.status(
            Level.WARNING,
            f"{topic.name}: the definition of {topic.type} is not known here; its messages stay bytes",
            _definition_status(topic),
        )
        for topic in _without_definition(topics)
    ]
    return [protocol.advertise(topics), *statuses]


def _without_definition(topics: Mapping[int, Topic]) -> list[Topic]:
    return [topic for topic in topics.values() if topic.schema is None]


def _definition_status(topic: Topic) -> str:
    return f"definition:{topic.name}:{topic.type}"
