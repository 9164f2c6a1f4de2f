"""Server of a port of this machine: who may connect, how many, and how long they may take.

Every server that gives others the graph is one of these, so that they admit and refuse alike.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import socket
import ssl
import threading
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import Future

from aiohttp import web
from aiohttp.http_exceptions import HttpProcessingError
from aiohttp.typedefs import Handler

from daidalos.studio.access import (
    TOKEN_QUERY,
    AccessPolicy,
    Refusal,
    entrance,
    identify,
    new_token,
    too_long,
)
from daidalos.studio.connections import Connection, Connections
from daidalos.studio.layouts import MAX_FILE_BYTES
from daidalos.studio.limits import HANDSHAKE_S
from daidalos.studio.local_users import is_of_another_user
from daidalos.studio.pages import HEADERS
from daidalos.studio.ports import (
    ACCEPTED_AT_ONCE,
    ANY_ADDRESS,
    BACKLOG,
    MAX_PORTS_TRIED,
    is_loopback,
    open_port,
    outward_address,
)
from daidalos.studio.stream_client import StreamClient

LOOPBACK = ("127.0.0.1", "::1")
MAX_FRAME_BYTES = 64 << 20  # what a client may send at once; a published image or cloud fits
CLOSE_TIMEOUT_S = 0.3
KEEP_ALIVE_S = 30.0
HEARTBEAT_S = 30.0


def _is_own_fault(record: logging.LogRecord) -> bool:
    """Return whether an error of HTTP is not the client's, who could fill the log with what is not HTTP."""
    return not (record.exc_info and isinstance(record.exc_info[1], HttpProcessingError | ConnectionError))


_HTTP_LOGGER = logging.getLogger(f"{__name__}.http")
_HTTP_LOGGER.addFilter(_is_own_fault)


class GuardedServer:
    """Serves HTTP and WebSockets from a thread of its own, behind the rules of `AccessPolicy` and `Connections`.

    Subclasses add their routes, and what happens while the port is open.

    Parameters
    ----------
    port
        The port to listen on; 0 for any.
    hosts
        Addresses to listen on; loopback unless told otherwise.
    allowed_hosts, allowed_origins
        See `AccessPolicy`.
    token
        What clients must send; None: nothing where the server listens on loopback, else a random one.
    tls
        Certificate and key; None: connections are not encrypted.
    ports_tried
        How many ports, from the wanted one on, are tried until one is free.
    """

    def __init__(
        self,
        *,
        port: int,
        hosts: Sequence[str] = LOOPBACK,
        allowed_hosts: Iterable[str] = (),
        allowed_origins: Iterable[str] = (),
        token: str | None = None,
        tls: ssl.SSLContext | None = None,
        ports_tried: int = MAX_PORTS_TRIED,
    ) -> None:
        self._wanted_port = port
        self._ports_tried = ports_tried
        self._hosts = tuple(hosts)
        if token is None and not all(map(is_loopback, self._hosts)):
            token = new_token()
        self._token = token
        self._tls = tls
        self._access = AccessPolicy(allowed_hosts, allowed_origins, token)
        self._connections = Connections()
        self._turns = asyncio.Lock()
        self._entry = asyncio.Lock()
        self._sockets: set[web.WebSocketResponse] = set()
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
        """The address for a client on this machine; with the token, where the server asks for one."""
        local = any(is_loopback(host) or host in ANY_ADDRESS for host in self._hosts)
        return self._address("localhost" if local else self._hosts[0])

    @property
    def remote_url(self) -> str | None:
        """The address for other machines; None where they cannot reach it."""
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

    def start(self) -> None:
        """Open the port and serve from a new thread; returns when clients can connect.

        Raises
        ------
        PortError
            When the address cannot be opened, or no port is free.
        """
        sockets = open_port(self._hosts, self._wanted_port, self._ports_tried)
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

    # What subclasses define ---------------------------------------------------------------------------------

    def _add_routes(self, app: web.Application) -> None:
        """Add the server's routes."""
        raise NotImplementedError

    def _opened(self) -> None:
        """Start what goes on while the port is open; called in the server's thread."""

    def _closed(self) -> None:
        """End it."""

    def _refused(self, request: web.Request, refusal: Refusal) -> None:
        """Report that a request was refused."""

    # The server's thread ------------------------------------------------------------------------------------

    def _soon(self, call: Callable[[], object]) -> None:
        """Call in the server's thread; from any thread."""
        loop = self._loop
        if loop is not None:
            with contextlib.suppress(RuntimeError):  # the loop has ended, and every client with it
                loop.call_soon_threadsafe(call)

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
        self._add_routes(app)
        runner = web.AppRunner(
            app,
            access_log=None,
            handle_signals=False,
            shutdown_timeout=CLOSE_TIMEOUT_S,
            keepalive_timeout=KEEP_ALIVE_S,
            logger=_HTTP_LOGGER,
        )
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
            self._opened()
            ready.set_result(None)
            await self._stopping.wait()
        finally:
            self._closed()
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
        async with self._entry:  # of many requests that come together, one begins in each step of the event loop
            await asyncio.sleep(0)
        refusal = too_long(request) or self._access.refusal(identify(request, self._port)) or self._other_user(request)
        if refusal is not None:
            self._refused(request, refusal)
            return web.Response(status=refusal.status, text=refusal.reason + "\n", headers=HEADERS)
        return (entrance(request, self._port, self._token) if self._token else None) or await handler(request)

    def _other_user(self, request: web.Request) -> Refusal | None:
        """Return the refusal of a connection by another user of this machine, where no token is asked for."""
        ends = [request.get_extra_info(name) for name in ("peername", "sockname")]
        if self._token is not None or None in ends or not is_of_another_user(*ends):
            return None
        return Refusal(403, "this server is another user's; it serves others only where it is started with a token")

    async def _open_socket(
        self,
        request: web.Request,
        subprotocols: Sequence[str] = (),
        *,
        heartbeat_s: float = HEARTBEAT_S,
        compress: bool = False,
    ) -> tuple[web.WebSocketResponse, Connection | None]:
        """Return the WebSocket of a request, and its connection; None where it was lost meanwhile.

        Parameters
        ----------
        request
            The request.
        subprotocols
            The protocols that the server speaks.
        heartbeat_s
            Period in which the client is asked for a sign of life, in seconds.
        compress
            Whether frames are compressed, which costs more than loopback and local networks give back.
        """
        opened = web.WebSocketResponse(
            protocols=subprotocols,
            compress=compress,
            heartbeat=heartbeat_s,
            max_msg_size=MAX_FRAME_BYTES,
            timeout=CLOSE_TIMEOUT_S,
        )
        await opened.prepare(request)
        return opened, self._connections.of(request.protocol)

    async def _run_client(self, client: StreamClient, opened: web.WebSocketResponse) -> None:
        """Serve a client until it leaves."""
        self._sockets.add(opened)
        try:
            await client.run()
        finally:
            self._sockets.discard(opened)
            error = opened.exception()
            while error is not None:
                error.__traceback__ = None  # its frames refer to the connection, which only the collector would free
                error = error.__context__
