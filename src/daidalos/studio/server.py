"""The studio's server: the page and the Foxglove WebSocket protocol on one port, in a thread of its own."""

from __future__ import annotations

import asyncio
import ssl
import uuid
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from aiohttp import web

from daidalos.studio import protocol
from daidalos.studio.arrangement import Arrangement
from daidalos.studio.assets import AssetResolver
from daidalos.studio.client import Client
from daidalos.studio.files import STATIC
from daidalos.studio.guarded_server import LOOPBACK, GuardedServer
from daidalos.studio.hub import Changes, Hub
from daidalos.studio.layouts import read_layout, write_layout, write_plots
from daidalos.studio.pages import (
    ARRANGEMENT_KEY,
    STATIC_KEY,
    arrangement_of,
    extension_module,
    extensions_of,
    page,
)
from daidalos.studio.protocol import Level
from daidalos.studio.source import GraphSource, Handle, Parameter, Topic

DEFAULT_PORT = 8765
REFRESH_DELAY_S = 0.05  # a graph changes in bursts when nodes start
TIME_PERIOD_S = 1 / 60  # a screen shows no more


class StudioServer(GuardedServer):
    """Serves a graph to browsers and to any client of the Foxglove WebSocket protocol.

    Parameters
    ----------
    source
        The graph.
    name
        What clients show as the name of the connection.
    port
        The port to listen on, or the next free one above; 0 for any.
    hosts, allowed_hosts, allowed_origins, token, tls
        See `GuardedServer`.
    assets
        Finds meshes and textures; None serves none.
    static
        Folder of the built page.
    metadata
        What else clients are told, e.g. ``{"ROS_DISTRO": "jazzy"}``.
    arrangement
        The layout with which the page opens; None: the page's default.
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
        super().__init__(
            port=port, hosts=hosts, allowed_hosts=allowed_hosts, allowed_origins=allowed_origins, token=token, tls=tls
        )
        self._source = source
        self._name = name
        self._assets = assets
        self._static = static
        self._metadata = dict(metadata or {})
        self._arrangement = arrangement
        self._session = uuid.uuid4().hex
        self._hub = Hub(source)
        self._clients: set[Client] = set()
        self._observing: Handle | None = None
        self._refresh_pending = False
        self._time: int | None = None
        self._time_pending = False

    @property
    def client_count(self) -> int:
        """How many clients are connected."""
        return len(self._clients)

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

    # The server's thread ----------------------------------------------------------------------------------

    def _add_routes(self, app: web.Application) -> None:
        app[STATIC_KEY] = self._static
        app[ARRANGEMENT_KEY] = self._arrangement
        app.router.add_get("/", self._root)
        app.router.add_get("/arrangement.json", arrangement_of)
        app.router.add_post("/layouts/read", read_layout)
        app.router.add_post("/layouts/rviz", write_layout)
        app.router.add_post("/layouts/plotjuggler", write_plots)
        app.router.add_get("/extensions.json", extensions_of)
        app.router.add_get("/extensions/{kind}/{name}/{path:.*}", extension_module)
        app.router.add_get("/{path:.*}", page)

    def _opened(self) -> None:
        self._time = self._source.time()
        self._observing = self._source.attach(self)
        self._hub.refresh()

    def _closed(self) -> None:
        if self._observing is not None:
            self._observing.close()

    async def _root(self, request: web.Request) -> web.StreamResponse:
        if "websocket" not in request.headers.get("Upgrade", "").lower():
            return await page(request)
        return await self._serve_client(request)

    async def _serve_client(self, request: web.Request) -> web.StreamResponse:
        offered = {name.strip() for name in request.headers.get("Sec-WebSocket-Protocol", "").split(",")}
        if not offered & set(protocol.SUBPROTOCOLS):
            known = " or ".join(protocol.SUBPROTOCOLS)
            return web.Response(status=400, text=f"expected the WebSocket subprotocol {known}\n")
        connection, link = await self._open_socket(request, protocol.SUBPROTOCOLS)
        if link is None:
            return connection
        client = Client(connection, self._source, self._hub, self._assets, self._connections, link, self._turns)
        for frame in self._first_frames():
            client.outbox.put_reply(frame)
        if self._time is not None:
            client.outbox.put_time(self._time)
        self._clients.add(client)
        try:
            await self._run_client(client, connection)
        finally:
            self._clients.discard(client)
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
