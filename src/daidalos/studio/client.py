"""One connected client: what it subscribed to, advertised and asked for."""

from __future__ import annotations

import asyncio
import contextlib
import logging
from collections.abc import Callable, Coroutine, Iterable, Sequence
from concurrent.futures import Future
from typing import Any

from aiohttp import WSMsgType, web

from daidalos.studio import frames, protocol
from daidalos.studio.assets import AssetError, AssetResolver
from daidalos.studio.frames import Publish, ServiceRequest
from daidalos.studio.hub import Hub
from daidalos.studio.outbox import Outbox
from daidalos.studio.protocol import Level, ProtocolError
from daidalos.studio.source import Graph, GraphSource, Handle, Parameter, Publication, SourceError

_LOGGER = logging.getLogger(__name__)

MAX_PENDING_REQUESTS = 256
"""Service calls, parameter requests and assets of one client that have no answer yet."""

MAX_ERROR_LENGTH = 500
"""Characters of an error's text, which may repeat what a client sent."""


class Client:
    """The server's side of one connection; lives in the server's event loop.

    Parameters
    ----------
    socket
        The prepared WebSocket.
    source, hub, assets
        The graph, the server's shared view of it, and the files that may be fetched.
    """

    def __init__(
        self, socket: web.WebSocketResponse, source: GraphSource, hub: Hub, assets: AssetResolver | None
    ) -> None:
        self._socket = socket
        self._source = source
        self._hub = hub
        self._assets = assets
        loop = asyncio.get_running_loop()
        self._awake = asyncio.Event()
        self.outbox = Outbox(lambda: _wake(loop, self._awake))
        self._subscriptions: dict[int, tuple[int, Handle]] = {}  # number -> channel and handle
        self._publications: dict[int, Publication] = {}
        self._watched: set[str] = set()
        self._watches_all = False
        self._graph: Graph | None = None  # as last sent; None: the client did not ask for it
        self._requests: set[asyncio.Task[None]] = set()

    async def run(self) -> None:
        """Receive and send until the connection ends or the server stops."""
        sender = asyncio.create_task(self._send())
        try:
            async for message in self._socket:
                if message.type is WSMsgType.TEXT:
                    self._receive(self._receive_text, message.data)
                elif message.type is WSMsgType.BINARY:
                    self._receive(self._receive_binary, message.data)
                if self.outbox.overflowed:
                    break  # it sends requests and does not read the responses
        finally:
            sender.cancel()
            for request in self._requests:
                request.cancel()
            for _, handle in self._subscriptions.values():
                handle.close()
            for publication in self._publications.values():
                publication.close()
            with contextlib.suppress(asyncio.CancelledError):
                await sender

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

    async def _send(self) -> None:
        with contextlib.suppress(ConnectionError):  # the receiving side sees the end as well and closes everything
            while True:
                frame = self.outbox.take()
                if frame is None:
                    await self._awake.wait()
                    self._awake.clear()
                elif isinstance(frame, str):
                    await self._socket.send_str(frame)
                else:
                    await self._socket.send_bytes(frame)

    def _receive(self, handle: Callable[[Any], None], data: str | bytes) -> None:
        try:
            handle(data)
        except (ProtocolError, SourceError) as error:
            self._send_error(str(error))
        except Exception as error:  # a fault of ours fails this request, and neither the client nor the server
            _LOGGER.exception("a client's request failed")
            self._send_error(f"the request failed: {type(error).__name__}")

    def _send_error(self, text: str) -> None:
        self.outbox.put_reply(protocol.status(Level.ERROR, text[:MAX_ERROR_LENGTH]))

    def _receive_text(self, data: str) -> None:
        match protocol.parse_text(data):
            case protocol.Subscribe(subscriptions):
                self._subscribe(subscriptions)
            case protocol.Unsubscribe(numbers):
                self._unsubscribe(numbers)
            case protocol.ClientAdvertise(channels):
                self._advertise(channels)
            case protocol.ClientUnadvertise(numbers):
                self._unadvertise(numbers)
            case protocol.GetParameters(names, request):
                self._start(self._answer_parameters(self._source.get_parameters(names), request))
            case protocol.SetParameters(entries, request):
                self._set_parameters(entries, request)
            case protocol.SubscribeParameterUpdates(names):
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
                self._start(self._answer_asset(request_id, uri))

    def _receive_binary(self, data: bytes) -> None:
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

    def _subscribe(self, subscriptions: Iterable[protocol.ChannelSubscription]) -> None:
        for wanted in subscriptions:
            number, channel = wanted.id, wanted.channel_id
            topic = self._hub.topics.get(channel)
            if number in self._subscriptions:
                self._send_error(f"subscription {number} exists already")
            elif topic is None:
                # A topic may vanish while the client asks for it: a warning, not an error.
                text = f"channel {channel} does not exist"
                self.outbox.put_reply(protocol.status(Level.WARNING, text))
            else:
                self.outbox.open(number, topic.latched)
                handle = self._hub.subscribe(channel, _deliver_to(self.outbox, number))
                self._subscriptions[number] = (channel, handle)

    def _unsubscribe(self, numbers: Iterable[int]) -> None:
        for number in numbers:
            if number in self._subscriptions:
                self._close_subscription(number)

    def _close_subscription(self, number: int) -> None:
        _, handle = self._subscriptions.pop(number)
        handle.close()
        self.outbox.close(number)

    def _advertise(self, channels: Iterable[protocol.ClientChannel]) -> None:
        for channel in channels:
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

    async def _answer_asset(self, request: int, uri: str) -> None:
        try:
            if self._assets is None:
                raise AssetError("this server has no assets")
            frame = frames.asset_frame(request, await asyncio.to_thread(self._assets.read, uri))
        except AssetError as error:
            frame = frames.asset_error_frame(request, str(error))
        self.outbox.put_reply(frame)

    def _start(self, request: Coroutine[Any, Any, None]) -> None:
        if len(self._requests) >= MAX_PENDING_REQUESTS or self.outbox.overflowed:
            request.close()
            raise ProtocolError(f"more than {MAX_PENDING_REQUESTS} requests under way")
        task = asyncio.create_task(request)
        self._requests.add(task)
        task.add_done_callback(self._requests.discard)

    # Parameters ------------------------------------------------------------------------------------------

    def _set_parameters(self, entries: Iterable[protocol.ParameterEntry], request: str | None) -> None:
        wanted = [protocol.parse_parameter(entry) for entry in entries]
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


def _wake(loop: asyncio.AbstractEventLoop, awake: asyncio.Event) -> None:
    with contextlib.suppress(RuntimeError):  # the loop has ended
        loop.call_soon_threadsafe(awake.set)


def _deliver_to(outbox: Outbox, subscription: int) -> Callable[[int, bytes], None]:
    return lambda nanoseconds, payload: outbox.put_message(subscription, nanoseconds, payload)
