"""One connected client: what it subscribed to, advertised and asked for."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable, Coroutine, Iterable, Sequence
from concurrent.futures import Future
from typing import Any

from aiohttp import web

from daidalos.studio import frames, protocol
from daidalos.studio.assets import AssetError, AssetResolver
from daidalos.studio.connections import Connection, Connections
from daidalos.studio.frames import Publish, ServiceRequest
from daidalos.studio.hub import Hub
from daidalos.studio.limits import (
    MAX_ENTRIES,
    MAX_ERROR_LENGTH,
    MAX_ERRORS,
    MAX_PENDING_REQUESTS,
    MAX_PUBLICATIONS,
    MAX_VALUES,
    MAX_WATCHED,
)
from daidalos.studio.outbox import Outbox
from daidalos.studio.protocol import Level, ProtocolError
from daidalos.studio.source import Graph, GraphSource, Handle, Parameter, Publication, SourceError
from daidalos.studio.stream_client import StreamClient

_ROOM_PERIOD_S = 0.1
"""Period in which an asset that waits checks whether there is room for it."""


class Client(StreamClient):
    """The server's side of one connection of the Foxglove protocol; lives in the server's event loop.

    Parameters
    ----------
    socket
        The prepared WebSocket.
    source, hub, assets
        The graph, the server's shared view of it, and the files that may be fetched.
    connections, connection, turns
        The server's connections, the client's own, and the order of the clients' turns.
    """

    def __init__(
        self,
        socket: web.WebSocketResponse,
        source: GraphSource,
        hub: Hub,
        assets: AssetResolver | None,
        connections: Connections,
        connection: Connection,
        turns: asyncio.Lock,
    ) -> None:
        super().__init__(socket, connections, connection, turns)
        self._wanted_assets: deque[tuple[int, str]] = deque()  # numbers of requests and URIs: a task each takes more
        self._sends_assets = False
        self._errors = 0
        self._source = source
        self._hub = hub
        self._assets = assets
        self._subscriptions: dict[int, tuple[int, Handle]] = {}  # number -> channel and handle
        self._subscribed: dict[int, int] = {}  # channel -> number
        self._publications: dict[int, Publication] = {}
        self._watched: set[str] = set()
        self._watches_all = False
        self._graph: Graph | None = None  # as last sent; None: the client did not ask for it
        self._requests: set[asyncio.Task[None]] = set()

    def _release(self) -> None:
        for request in self._requests:
            request.cancel()
        for _, handle in self._subscriptions.values():
            handle.close()
        for publication in self._publications.values():
            publication.close()

    def graph_changed(self, graph: Graph) -> None:
        """Send the changes of the graph, if the client asked for them."""
        if self._graph is not None:
            update = protocol.connection_graph_update(self._graph, graph)
            self._graph = graph
            if update is not None:
                self.outbox.put_reply(update)

    def parameters_changed(self, parameters: Sequence[Parameter]) -> None:
        """Send new values of the parameters that the client watches."""
        watched = [each for each in parameters if self._watches_all or each.name in self._watched]
        if watched:
            self.outbox.put_reply(protocol.parameter_values(watched))

    def channels_gone(self, channels: set[int]) -> None:
        """Close subscriptions to channels that no longer exist."""
        gone = [number for number, (channel, _) in self._subscriptions.items() if channel in channels]
        for number in gone:
            self._close_subscription(number)

    async def _receive(self, handle: Callable[[Any], Coroutine[Any, Any, None]], data: str | bytes) -> None:
        self._errors = 0

        async def attempt(data: str | bytes) -> None:
            try:
                await handle(data)
            except (ProtocolError, SourceError) as error:
                self._send_error(str(error))

        await super()._receive(attempt, data)

    def _send_error(self, text: str, level: Level = Level.ERROR) -> None:
        """Send an error of the request under way; of many alike, the first ones."""
        self._errors += 1
        if self._errors <= MAX_ERRORS:
            self.outbox.put_reply(protocol.status(level, text[:MAX_ERROR_LENGTH]))

    async def _receive_text(self, data: str) -> None:
        match await self._turn.share_steps(protocol.parse_text(data, MAX_ENTRIES, MAX_VALUES)):
            case protocol.Subscribe(subscriptions):
                await self._subscribe(subscriptions)
            case protocol.Unsubscribe(numbers):
                self._unsubscribe(numbers)
            case protocol.ClientAdvertise(channels):
                await self._advertise(channels)
            case protocol.ClientUnadvertise(numbers):
                self._unadvertise(numbers)
            case protocol.GetParameters(names, request):
                self._start(self._answer_parameters(self._source.get_parameters(names), request))
            case protocol.SetParameters(entries, request):
                await self._set_parameters(entries, request)
            case protocol.SubscribeParameterUpdates(names):
                if len(self._watched) + len(names) > MAX_WATCHED:
                    raise ProtocolError(f"more than {MAX_WATCHED} parameters are watched; name none to watch all")
                self._watched.update(names)
                self._watches_all = self._watches_all or not names
            case protocol.UnsubscribeParameterUpdates(names):
                self._unsubscribe_parameters(names)
            case protocol.SubscribeConnectionGraph():
                self._graph = Graph()
                self.graph_changed(self._source.graph())
            case protocol.UnsubscribeConnectionGraph():
                self._graph = None
            case protocol.FetchAsset(request_id, uri):
                self._check_pending()
                self._wanted_assets.append((request_id, uri))
                if not self._sends_assets:
                    self._sends_assets = True
                    self._start(self._answer_assets())

    async def _receive_binary(self, data: bytes) -> None:
        match frames.parse_binary(data):
            case Publish(channel, payload):
                publication = self._publications.get(channel)
                if publication is None:
                    raise ProtocolError(f"channel {channel} is not advertised")
                publication.publish(payload)
            case ServiceRequest() as request:
                self._call(request)
            case _:
                raise ProtocolError("this server does not play recordings")

    # Topics ----------------------------------------------------------------------------------------------

    async def _subscribe(self, subscriptions: Iterable[protocol.ChannelSubscription]) -> None:
        for wanted in subscriptions:
            number, channel = wanted.id, wanted.channel_id
            topic = self._hub.topics.get(channel)
            if number in self._subscriptions:
                self._send_error(f"subscription {number} exists already")
            elif channel in self._subscribed:
                self._send_error(f"channel {channel} is subscribed to already", Level.WARNING)
            elif topic is None:
                # A topic may vanish while the client asks for it: a warning, not an error.
                self._send_error(f"channel {channel} does not exist", Level.WARNING)
            else:
                self.outbox.open(number, topic.latched)
                handle = self._hub.subscribe(channel, _deliver_to(self.outbox, number))
                self._subscriptions[number] = (channel, handle)
                self._subscribed[channel] = number
            await self._turn.share()

    def _unsubscribe(self, numbers: Iterable[int]) -> None:
        for number in numbers:
            if number in self._subscriptions:
                self._close_subscription(number)

    def _close_subscription(self, number: int) -> None:
        channel, handle = self._subscriptions.pop(number)
        del self._subscribed[channel]
        handle.close()
        self.outbox.close(number)

    async def _advertise(self, channels: Iterable[protocol.ClientChannel]) -> None:
        for channel in channels:
            await self._turn.share()
            if len(self._publications) >= MAX_PUBLICATIONS:
                raise ProtocolError(f"more than {MAX_PUBLICATIONS} channels are advertised")
            if channel.id in self._publications:
                self._send_error(f"channel {channel.id} is advertised already")
            elif channel.encoding != protocol.ENCODING:
                self._send_error(
                    f"{channel.topic}: encoding {channel.encoding!r}; this server only takes {protocol.ENCODING}"
                )
            else:
                type_name = protocol.full_type_name(channel.schema_name)
                self._publications[channel.id] = self._source.advertise(channel.topic, type_name)

    def _unadvertise(self, numbers: Iterable[int]) -> None:
        for number in numbers:
            publication = self._publications.pop(number, None)
            if publication is not None:
                publication.close()

    # Requests --------------------------------------------------------------------------------------------

    def _call(self, request: ServiceRequest) -> None:
        service = self._hub.services.get(request.service)
        if service is None:
            self._refuse_call(request, f"service {request.service} does not exist")
        elif request.encoding != protocol.ENCODING:
            self._refuse_call(request, f"encoding {request.encoding!r}; this server only takes {protocol.ENCODING}")
        else:
            self._start(self._answer_call(request, self._source.call(service.name, request.payload)))

    async def _answer_call(self, request: ServiceRequest, future: Future[bytes]) -> None:
        try:
            response = await asyncio.wrap_future(future)
        except SourceError as error:
            self._refuse_call(request, str(error))
        else:
            frame = frames.service_response_frame(request.service, request.call, response)
            self.outbox.put_reply(frame)

    def _refuse_call(self, request: ServiceRequest, reason: str) -> None:
        self.outbox.put_reply(protocol.ServiceCallFailure(request.service, request.call, reason).encode())

    async def _answer_assets(self) -> None:
        try:
            while self._wanted_assets:
                while self.outbox.reply_bytes:
                    self._drained.clear()
                    await self._drained.wait()
                async with self._connections.room:  # of all clients, one has an asset read
                    while not self._connections.has_room():
                        await asyncio.sleep(_ROOM_PERIOD_S)
                    self.outbox.put_reply(await self._asset_frame(*self._wanted_assets.popleft()))
        finally:
            self._sends_assets = False

    async def _asset_frame(self, request: int, uri: str) -> bytes | bytearray:
        try:
            if self._assets is None:
                raise AssetError("this server has no assets")
            return await asyncio.to_thread(self._assets.read, uri, frames.asset_head(request))
        except AssetError as error:
            return frames.asset_error_frame(request, str(error))

    def _check_pending(self) -> None:
        """Raise a `ProtocolError` where the client has as many requests under way as it may."""
        pending = len(self._requests) + len(self._wanted_assets)
        if pending >= MAX_PENDING_REQUESTS or self.outbox.overflowed:
            raise ProtocolError(f"more than {MAX_PENDING_REQUESTS} requests under way")

    def _start(self, request: Coroutine[Any, Any, None]) -> None:
        try:
            self._check_pending()
        except ProtocolError:
            request.close()
            raise
        task = asyncio.create_task(request)
        self._requests.add(task)
        task.add_done_callback(self._requests.discard)

    # Parameters ------------------------------------------------------------------------------------------

    async def _set_parameters(self, entries: Iterable[protocol.ParameterEntry], request: str | None) -> None:
        wanted = []
        for entry in entries:
            wanted.append(protocol.parse_parameter(entry))
            await self._turn.share()
        self._start(self._answer_parameters(self._source.set_parameters(wanted), request, silent=request is None))

    async def _answer_parameters(
        self, future: Future[Sequence[Parameter]], request: str | None, *, silent: bool = False
    ) -> None:
        try:
            parameters = await asyncio.wrap_future(future)
        except SourceError as error:
            self._send_error(str(error))
        else:
            if not silent:
                self.outbox.put_reply(protocol.parameter_values(parameters, request))

    def _unsubscribe_parameters(self, names: Sequence[str]) -> None:
        if names:
            self._watched.difference_update(names)
        else:
            self._watched.clear()
            self._watches_all = False


def _deliver_to(outbox: Outbox, subscription: int) -> Callable[[int, bytes], None]:
    return lambda nanoseconds, payload: outbox.put_message(subscription, nanoseconds, payload)
