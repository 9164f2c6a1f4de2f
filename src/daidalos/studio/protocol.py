"""The JSON messages of the Foxglove WebSocket protocol, of both sides; the page's types are generated from them.

Published at the Foxglove project as "Foxglove WebSocket Protocol v1". Text frames are JSON objects with an
``op``; the binary frames are in `daidalos.studio.frames`.
"""

from __future__ import annotations

import base64
import json
import math
import reprlib
from collections.abc import Generator, Iterable, Mapping
from dataclasses import dataclass
from enum import IntEnum
from typing import Any, ClassVar

from daidalos.studio.records import RecordError, Uint32, from_json_in_steps, to_json
from daidalos.studio.source import Graph, Parameter, Service, Topic

SUBPROTOCOLS = ("foxglove.sdk.v1", "foxglove.websocket.v1")
CAPABILITIES = (
    "clientPublish",
    "parameters",
    "parametersSubscribe",
    "services",
    "connectionGraph",
    "assets",
)
ENCODING = "cdr"
SCHEMA_ENCODING = "ros2msg"


class ProtocolError(Exception):
    """A frame that does not follow the protocol; the text is for the client's developer."""


class Level(IntEnum):
    """How serious a status is."""

    INFO = 0
    WARNING = 1
    ERROR = 2


# What a server says --------------------------------------------------------------------------------------


class ServerMessage:
    """A message from the server to a client."""

    op: ClassVar[str]
    kinds: ClassVar[dict[str, type[ServerMessage]]] = {}

    def __init_subclass__(cls, op: str) -> None:
        cls.op = op
        cls.kinds[op] = cls

    def encode(self) -> str:
        """Return the text frame."""
        return json.dumps({"op": self.op, **to_json(self)}, separators=(",", ":"))


@dataclass(frozen=True)
class ServerInfo(ServerMessage, op="serverInfo"):
    """The server's name and what it can do; clients keep what they have where the session is the same."""

    name: str
    capabilities: tuple[str, ...]
    supported_encodings: tuple[str, ...] | None = None
    metadata: Mapping[str, str] | None = None
    session_id: str | None = None


@dataclass(frozen=True)
class Status(ServerMessage, op="status"):
    """A text for the client's user; with an identifier it stays until `RemoveStatus`."""

    level: Level
    message: str
    id: str | None = None


@dataclass(frozen=True)
class RemoveStatus(ServerMessage, op="removeStatus"):
    """Statuses that no longer hold."""

    status_ids: tuple[str, ...]


@dataclass(frozen=True)
class Channel:
    """A topic under a number; without a schema encoding, nobody knows the definition."""

    id: int
    topic: str
    encoding: str
    schema_name: str
    schema: str
    schema_encoding: str | None = None


@dataclass(frozen=True)
class Advertise(ServerMessage, op="advertise"):
    """Topics that can be subscribed to."""

    channels: tuple[Channel, ...]


@dataclass(frozen=True)
class Unadvertise(ServerMessage, op="unadvertise"):
    """Channels that are gone."""

    channel_ids: tuple[int, ...]


@dataclass(frozen=True)
class ServiceSchema:
    """The definition of a service's requests or responses."""

    encoding: str
    schema_name: str
    schema_encoding: str
    schema: str


@dataclass(frozen=True)
class AdvertisedService:
    """A service under a number; servers of the protocol's first version only give the last two fields."""

    id: int
    name: str
    type: str
    request: ServiceSchema | None = None
    response: ServiceSchema | None = None
    request_schema: str | None = None
    response_schema: str | None = None


@dataclass(frozen=True)
class AdvertiseServices(ServerMessage, op="advertiseServices"):
    """Services that can be called."""

    services: tuple[AdvertisedService, ...]


@dataclass(frozen=True)
class UnadvertiseServices(ServerMessage, op="unadvertiseServices"):
    """Services that are gone."""

    service_ids: tuple[int, ...]


@dataclass(frozen=True)
class ServiceCallFailure(ServerMessage, op="serviceCallFailure"):
    """Why a call has no response."""

    service_id: int
    call_id: int
    message: str


@dataclass(frozen=True)
class ParameterEntry:
    """A parameter's name and value; without a value it is not set.

    ``type`` is ``byte_array`` (base64), ``float64`` or ``float64_array`` where JSON alone would not tell.
    """

    name: str
    value: Any = None
    type: str | None = None


@dataclass(frozen=True)
class ParameterValues(ServerMessage, op="parameterValues"):
    """Values of parameters, as the answer to a request where that is named."""

    parameters: tuple[ParameterEntry, ...]
    id: str | None = None


@dataclass(frozen=True)
class PublishedTopic:
    """The nodes that publish a topic."""

    name: str
    publisher_ids: tuple[str, ...]


@dataclass(frozen=True)
class SubscribedTopic:
    """The nodes that subscribe to a topic."""

    name: str
    subscriber_ids: tuple[str, ...]


@dataclass(frozen=True)
class ProvidedService:
    """The nodes that provide a service."""

    name: str
    provider_ids: tuple[str, ...]


@dataclass(frozen=True)
class ConnectionGraphUpdate(ServerMessage, op="connectionGraphUpdate"):
    """What changed of who publishes, subscribes and serves; a name without nodes has none any more."""

    published_topics: tuple[PublishedTopic, ...]
    subscribed_topics: tuple[SubscribedTopic, ...]
    advertised_services: tuple[ProvidedService, ...]
    removed_topics: tuple[str, ...]
    removed_services: tuple[str, ...]


# What a client says --------------------------------------------------------------------------------------


class ClientMessage:
    """A message from a client to the server."""

    op: ClassVar[str]
    kinds: ClassVar[dict[str, type[ClientMessage]]] = {}

    def __init_subclass__(cls, op: str) -> None:
        cls.op = op
        cls.kinds[op] = cls


@dataclass(frozen=True)
class ChannelSubscription:
    """A subscription, numbered by the client, to a channel."""

    id: Uint32
    channel_id: Uint32


@dataclass(frozen=True)
class Subscribe(ClientMessage, op="subscribe"):
    """Subscriptions to open."""

    subscriptions: tuple[ChannelSubscription, ...]


@dataclass(frozen=True)
class Unsubscribe(ClientMessage, op="unsubscribe"):
    """Subscriptions to close."""

    subscription_ids: tuple[int, ...]


@dataclass(frozen=True)
class ClientChannel:
    """A topic that the client publishes, under a number of its own."""

    id: Uint32
    topic: str
    encoding: str
    schema_name: str
    schema: str | None = None
    schema_encoding: str | None = None


@dataclass(frozen=True)
class ClientAdvertise(ClientMessage, op="advertise"):
    """Topics that the client will publish."""

    channels: tuple[ClientChannel, ...]


@dataclass(frozen=True)
class ClientUnadvertise(ClientMessage, op="unadvertise"):
    """Topics that the client no longer publishes."""

    channel_ids: tuple[int, ...]


@dataclass(frozen=True)
class GetParameters(ClientMessage, op="getParameters"):
    """A request for parameters' values, of all where none is named."""

    parameter_names: tuple[str, ...]
    id: str | None = None


@dataclass(frozen=True)
class SetParameters(ClientMessage, op="setParameters"):
    """New values of parameters; answered where the request has an identifier."""

    parameters: tuple[ParameterEntry, ...]
    id: str | None = None


@dataclass(frozen=True)
class SubscribeParameterUpdates(ClientMessage, op="subscribeParameterUpdates"):
    """Parameters whose new values the client wants to hear, all where none is named."""

    parameter_names: tuple[str, ...]


@dataclass(frozen=True)
class UnsubscribeParameterUpdates(ClientMessage, op="unsubscribeParameterUpdates"):
    """Parameters whose new values the client no longer wants to hear, all where none is named."""

    parameter_names: tuple[str, ...]


@dataclass(frozen=True)
class SubscribeConnectionGraph(ClientMessage, op="subscribeConnectionGraph"):
    """A request for the graph and all its changes."""


@dataclass(frozen=True)
class UnsubscribeConnectionGraph(ClientMessage, op="unsubscribeConnectionGraph"):
    """The end of `SubscribeConnectionGraph`."""


@dataclass(frozen=True)
class FetchAsset(ClientMessage, op="fetchAsset"):
    """A request for a mesh, a texture or the like."""

    request_id: Uint32
    uri: str


def parse_text(
    frame: str, max_entries: int | None = None, max_values: int | None = None
) -> Generator[None, None, ClientMessage]:
    """Read a client's text frame in steps: a JSON object with a string ``op``.

    Parameters
    ----------
    frame
        The frame.
    max_entries
        The longest list that is read, in steps of an entry.
    max_values
        How many commas the frame may have, which bound the values that are read in one step.

    Raises
    ------
    ProtocolError
        When it is anything else, or a field is not what it must be.
    """
    if max_values is not None and frame.count(",") > max_values:
        raise ProtocolError(f"a text frame has more than {max_values} values")
    try:
        message = json.loads(frame)
        if "\\u" in frame:
            json.dumps(message, ensure_ascii=False).encode()  # a lone surrogate could not be sent back
    except (ValueError, RecursionError) as error:
        raise ProtocolError(f"not JSON: {error}") from None
    if not isinstance(message, dict) or not isinstance(message.get("op"), str):
        raise ProtocolError('expected a JSON object with a string "op"')
    for name, value in message.items():
        if max_entries is not None and isinstance(value, list) and len(value) > max_entries:
            raise ProtocolError(f"{name[:40]} has {len(value)} entries; at most {max_entries} are taken at once")
    kind = ClientMessage.kinds.get(message["op"])
    if kind is None:
        raise ProtocolError(f"unknown op {message['op']!r}")
    try:
        return (yield from from_json_in_steps(kind, message))
    except RecordError as error:
        raise ProtocolError(str(error)) from None


# Messages from what the graph holds ----------------------------------------------------------------------


def server_info(name: str, session: str, has_time: bool, metadata: Mapping[str, str]) -> str:
    """Build the server's introduction.

    The ``time`` capability is claimed only once there is a time: clients that see it wait for time frames
    and stand still without them.
    """
    capabilities = (*CAPABILITIES, *(["time"] if has_time else []))
    return ServerInfo(name, capabilities, (ENCODING,), metadata, session).encode()


def status(level: Level, text: str, identifier: str | None = None) -> str:
    """Build a text for the client's user."""
    return Status(level, text, identifier).encode()


def advertise(channels: Mapping[int, Topic]) -> str:
    """Offer topics under channel numbers."""
    return Advertise(
        tuple(
            Channel(
                number,
                topic.name,
                ENCODING,
                topic.type,
                topic.schema or "",
                # Left out where nobody knows the definition; an empty one is a message without fields.
                None if topic.schema is None else SCHEMA_ENCODING,
            )
            for number, topic in channels.items()
        )
    ).encode()


def advertise_services(services: Mapping[int, Service]) -> str:
    """Offer services under numbers."""
    return AdvertiseServices(
        tuple(
            AdvertisedService(
                number,
                service.name,
                service.type,
                ServiceSchema(ENCODING, f"{service.type}_Request", SCHEMA_ENCODING, service.request_schema),
                ServiceSchema(ENCODING, f"{service.type}_Response", SCHEMA_ENCODING, service.response_schema),
                service.request_schema,
                service.response_schema,
            )
            for number, service in services.items()
        )
    ).encode()


def parameter_values(parameters: Iterable[Parameter], request: str | None = None) -> str:
    """Build parameters' values, as an answer where a request is named."""
    return ParameterValues(tuple(_entry(parameter) for parameter in parameters), request).encode()


def _entry(parameter: Parameter) -> ParameterEntry:
    name, value = parameter.name, parameter.value
    if isinstance(value, bytes):
        return ParameterEntry(name, base64.b64encode(value).decode(), "byte_array")
    if isinstance(value, float):
        return ParameterEntry(name, _number(value), "float64")
    if isinstance(value, list) and any(isinstance(item, float) for item in value):
        return ParameterEntry(name, [_number(float(item)) for item in value], "float64_array")
    return ParameterEntry(name, value)


def _number(value: float) -> float | str:
    """Return a number as JSON can hold it; Python and JavaScript read the texts of what is not finite."""
    if math.isfinite(value):
        return value
    return "NaN" if math.isnan(value) else "Infinity" if value > 0 else "-Infinity"


def parse_parameter(entry: ParameterEntry) -> Parameter:
    """Read one entry of ``setParameters``; a missing value unsets the parameter.

    Raises
    ------
    ProtocolError
        When it has a value that a ROS parameter cannot hold.
    """
    name, value = entry.name, entry.value
    try:
        if entry.type == "byte_array":
            return Parameter(name, base64.b64decode(value, validate=True))
        if entry.type == "float64":
            return Parameter(name, float(value))
        if entry.type == "float64_array":
            return Parameter(name, [float(item) for item in value])
    except (TypeError, ValueError):
        raise ProtocolError(f"parameter {name}: {value!r} is not a {entry.type}") from None
    if not _is_parameter_value(value):
        raise ProtocolError(f"parameter {name}: ROS parameters cannot hold {reprlib.repr(value)}")
    return Parameter(name, value)


_MIN_INTEGER, _MAX_INTEGER = -(2**63), 2**63 - 1


def _is_parameter_value(value: object) -> bool:
    if isinstance(value, list):
        kinds = {type(item) for item in value}
        alike = kinds <= {bool} or kinds <= {int} or kinds <= {int, float} or kinds <= {str}
        return alike and all(_is_parameter_value(item) for item in value)
    if isinstance(value, int):
        return _MIN_INTEGER <= value <= _MAX_INTEGER
    return value is None or isinstance(value, float | str)


def connection_graph_update(before: Graph, after: Graph) -> str | None:
    """Build what changed between two graphs; None where nothing did."""
    topics = before.publishers.keys() | before.subscribers.keys()
    topics_now = after.publishers.keys() | after.subscribers.keys()
    update = ConnectionGraphUpdate(
        tuple(PublishedTopic(*change) for change in _changed(before.publishers, after.publishers)),
        tuple(SubscribedTopic(*change) for change in _changed(before.subscribers, after.subscribers)),
        tuple(ProvidedService(*change) for change in _changed(before.services, after.services)),
        tuple(sorted(topics - topics_now)),
        tuple(sorted(before.services.keys() - after.services.keys())),
    )
    return update.encode() if any(to_json(update).values()) else None


def _changed(
    before: Mapping[str, frozenset[str]], after: Mapping[str, frozenset[str]]
) -> list[tuple[str, tuple[str, ...]]]:
    gone = {name: frozenset[str]() for name in before.keys() - after.keys()}
    return [
        (name, tuple(sorted(nodes)))
        for name, nodes in sorted({**after, **gone}.items())
        if before.get(name, frozenset()) != nodes
    ]


def full_type_name(name: str) -> str:
    """Return a message type's name in full: clients leave ``/msg/`` out or put it in."""
    parts = name.split("/")
    return f"{parts[0]}/msg/{parts[1]}" if len(parts) == 2 else name
