"""One connected client: what it subscribed to, advertised and asked for."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Callable, Coroutine, Sequence
from concurrent.futures import Future
from typing import Any, TypeVar

from aiohttp import WSMsgType, web

from daidalos.studio import protocol
from daidalos.studio.assets import AssetError, AssetResolver
from daidalos.studio.hub import Hub
from daidalos.studio.outbox import Outbox
from daidalos.studio.protocol import Level, ProtocolError, Publish, ServiceRequest
from daidalos.studio.source import Graph, GraphSource, Handle, Parameter, Publication, SourceError

REQUESTS_AT_ONCE = 256
"""Service calls, parameter requests and assets that one client may have under way."""

T = TypeVar("T")


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
        self._graph: Graph | None = None  # what the client was told of the graph; None: it does not ask
        self._requests: set[asyncio.Task[None]] = set()
        self._operations: dict[str, Callable[[dict[str, Any]], None]] = {
            "subscribe": self._subscribe,
            "unsubscribe": self._unsubscribe,
            "advertise": self._advertise,
            "unadvertise": self._unadvertise,
            "getParameters": self._get_parameters,
            "setParameters": self._set_parameters,
            "subscribeParameterUpdates": self._subscribe_parameters,
            "unsubscribeParameterUpdates": self._unsubscribe_parameters,
            "subscribeConnectionGraph": self._subscribe_graph,
            "unsubscribeConnectionGraph": self._unsubscribe_graph,
            "fetchAsset": self._fetch_asset,
        }

    async def run(self) -> None:
        """Talk until the client leaves or the server stops."""
        sender = asyncio.create_task(self._send())
        try:
            async for message in self._socket:
                if message.type is WSMsgType.TEXT:
                    self._receive(self._receive_text, message.data)
                elif message.type is WSMsgType.BINARY:
                    self._receive(self._receive_binary, message.data)
                if self.outbox.overflowed:
                    break  # it asks and asks, and reads nothing
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
        """Tell the client what is new in the graph, if it asked."""
        if self._graph is not None:
            update = protocol.connection_graph_update(self._graph, graph)
            self._graph = graph
            if update is not None:
                self.outbox.put_reply(update)

    def parameters_changed(self, parameters: Sequence[Parameter]) -> None:
        """Tell the client new values of the parameters that it watches."""
        watched = [each for each in parameters if self._watches_all or each.name in self._watched]
        if watched:
            self.outbox.put_reply(protocol.parameter_values(watched))

    def channels_gone(self, channels: set[int]) -> None:
        """Forget subscriptions to channels that no longer exist."""
        gone = [number for number, (channel, _) in self._subscriptions.items() if channel in channels]
        for number in gone:
            self._close_subscription(number)

    async def _send(self) -> None:
        with contextlib.suppress(ConnectionError):  # the receiving side sees the same end and tidies up
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
            self._complain(str(error))

    def _complain(self, text: str) -> None:
        self.outbox.put_reply(protocol.status(Level.ERROR, text))

    def _receive_text(self, data: str) -> None:
        message = protocol.parse_text(data)
        operation = self._operations.get(message["op"])
        if operation is None:
            raise ProtocolError(f"unknown op {message['op']!r}")
        operation(message)

    def _receive_binary(self, data: bytes) -> None:
        match protocol.parse_binary(data):
            case Publish(channel, payload):
                publication = self._publications.get(channel)
                if publication is None:
                    raise ProtocolError(f"channel {channel} is not advertised")
                publication.publish(payload)
            case ServiceRequest() as request:
                self._call(request)
            case _:
                raise ProtocolError("this server plays no recording")

    # Topics ----------------------------------------------------------------------------------------------

    def _subscribe(self, message: dict[str, Any]) -> None:
        for entry in _entries(message, "subscriptions"):
            number, channel = _number(entry, "id"), _number(entry, "channelId")
            topic = self._hub.topics.get(channel)
            if number in self._subscriptions:
                self._complain(f"subscription {number} exists already")
            elif topic is None:
                # A topic may vanish while the client asks for it: worth a word, not an error.
                text = f"channel {channel} does not exist"
                self.outbox.put_reply(protocol.status(Level.WARNING, text))
            else:
                self.outbox.open(number, topic.latched)
                handle = self._hub.listen(channel, _deliver_to(self.outbox, number))
                self._subscriptions[number] = (channel, handle)

    def _unsubscribe(self, message: dict[str, Any]) -> None:
        for number in _numbers(message, "subscriptionIds"):
            if number in self._subscriptions:
                self._close_subscription(number)

    def _close_subscription(self, number: int) -> None:
        _, handle = self._subscriptions.pop(number)
        handle.close()
        self.outbox.close(number)

    def _advertise(self, message: dict[str, Any]) -> None:
        for entry in _entries(message, "channels"):
            number, topic = _number(entry, "id"), _text(entry, "topic")
            encoding, name = _text(entry, "encoding"), _text(entry, "schemaName")
            if number in self._publications:
                self._complain(f"channel {number} is advertised already")
            elif encoding != protocol.ENCODING:
                self._complain(f"{topic}: encoding {encoding!r}; this server speaks {protocol.ENCODING}")
            else:
                self._publications[number] = self._source.advertise(topic, protocol.full_type_name(name))

    def _unadvertise(self, message: dict[str, Any]) -> None:
        for number in _numbers(message, "channelIds"):
            publication = self._publications.pop(number, None)
            if publication is not None:
                publication.close()

    # Requests --------------------------------------------------------------------------------------------

    def _call(self, request: ServiceRequest) -> None:
        service = self._hub.services.get(request.service)
        if service is None:
            self._refuse_call(request, f"service {request.service} does not exist")
        elif request.encoding != protocol.ENCODING:
            self._refuse_call(request, f"encoding {request.encoding!r}; this server speaks cdr")
        else:
            self._start(self._answer_call(request, self._source.call(service.name, request.payload)))

    async def _answer_call(self, request: ServiceRequest, future: Future[bytes]) -> None:
        try:
            response = await asyncio.wrap_future(future)
        except SourceError as error:
            self._refuse_call(request, str(error))
        else:
            frame = protocol.service_response_frame(request.service, request.call, response)
            self.outbox.put_reply(frame)

    def _refuse_call(self, request: ServiceRequest, reason: str) -> None:
        self.outbox.put_reply(protocol.service_call_failure(request.service, request.call, reason))

    def _fetch_asset(self, message: dict[str, Any]) -> None:
        self._start(self._answer_asset(_number(message, "requestId"), _text(message, "uri")))

    async def _answer_asset(self, request: int, uri: str) -> None:
        try:
            if self._assets is None:
                raise AssetError("this server has no assets")
            frame = protocol.asset_frame(request, await asyncio.to_thread(self._assets.read, uri))
        except AssetError as error:
            frame = protocol.asset_error_frame(request, str(error))
        self.outbox.put_reply(frame)

    def _start(self, request: Coroutine[Any, Any, None]) -> None:
        if len(self._requests) >= REQUESTS_AT_ONCE or self.outbox.overflowed:
            request.close()
            raise ProtocolError(f"more than {REQUESTS_AT_ONCE} requests under way")
        task = asyncio.create_task(request)
        self._requests.add(task)
        task.add_done_callback(self._requests.discard)

    # Parameters ------------------------------------------------------------------------------------------

    def _get_parameters(self, message: dict[str, Any]) -> None:
        names = _texts(message, "parameterNames")
        self._start(self._answer_parameters(self._source.get_parameters(names), _request_id(message)))

    def _set_parameters(self, message: dict[str, Any]) -> None:
        wanted = [protocol.parse_parameter(entry) for entry in _entries(message, "parameters")]
        request = _request_id(message)
        self._start(self._answer_parameters(self._source.set_parameters(wanted), request, silent=request is None))

    async def _answer_parameters(
        self, future: Future[Sequence[Parameter]], request: str | None, *, silent: bool = False
    ) -> None:
        try:
            parameters = await asyncio.wrap_future(future)
        except SourceError as error:
            self._complain(str(error))
        else:
            if not silent:
                self.outbox.put_reply(protocol.parameter_values(parameters, request))

    def _subscribe_parameters(self, message: dict[str, Any]) -> None:
        names = _texts(message, "parameterNames")
        self._watched.update(names)
        self._watches_all = self._watches_all or not names

    def _unsubscribe_parameters(self, message: dict[str, Any]) -> None:
        names = _texts(message, "parameterNames")
        if names:
            self._watched.difference_update(names)
        else:
            self._watched.clear()
            self._watches_all = False

    # Graph -----------------------------------------------------------------------------------------------

    def _subscribe_graph(self, message: dict[str, Any]) -> None:
        self._graph = Graph()
        self.graph_changed(self._source.graph())

    def _unsubscribe_graph(self, message: dict[str, Any]) -> None:
        self._graph = None


def _wake(loop: asyncio.AbstractEventLoop, awake: asyncio.Event) -> None:
    with contextlib.suppress(RuntimeError):  # the loop has ended: nobody is left to be woken
        loop.call_soon_threadsafe(awake.set)


def _deliver_to(outbox: Outbox, subscription: int) -> Callable[[int, bytes], None]:
    return lambda nanoseconds, payload: outbox.put_message(subscription, nanoseconds, payload)


# Fields of a client's message; each raises ProtocolError where the field is not what it must be -----------


def _entries(message: dict[str, Any], key: str) -> list[dict[str, Any]]:
    return _list_of(dict, "objects", message, key)


def _numbers(message: dict[str, Any], key: str) -> list[int]:
    return _list_of(int, "numbers", message, key)


def _texts(message: dict[str, Any], key: str) -> list[str]:
    return _list_of(str, "strings", message, key)


def _list_of(kind: type[T], word: str, message: dict[str, Any], key: str) -> list[T]:
    value = message.get(key)
    if not isinstance(value, list) or not all(isinstance(item, kind) for item in value):
        raise ProtocolError(f'expected "{key}" to be a list of {word}')
    return value


def _number(message: dict[str, Any], key: str) -> int:
    value = message.get(key)
    if not isinstance(value, int) or not 0 <= value < 1 << 32:
        raise ProtocolError(f'expected "{key}" to be a number of 32 bits')
    return value


def _text(message: dict[str, Any], key: str) -> str:
    value = message.get(key)
    if not isinstance(value, str):
        raise ProtocolError(f'expected "{key}" to be a string')
    return value


def _request_id(message: dict[str, Any]) -> str | None:
    value = message.get("id")
    if value is not None and not isinstance(value, str):
        raise ProtocolError('expected "id" to be a string')
    return value
