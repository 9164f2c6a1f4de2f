"""The Foxglove WebSocket protocol's frames: building what a server says, reading what a client says.

Published at the Foxglove project as "Foxglove WebSocket Protocol v1"; all integers are little-endian.
Text frames are JSON objects with an ``op``; binary frames start with an opcode.
"""

from __future__ import annotations

import base64
import json
import math
import struct
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

from daidalos.studio.source import Graph, Parameter, ParameterValue, Service, Topic

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

_MESSAGE = struct.Struct("<BIQ")
_TIME = struct.Struct("<BQ")
_SERVICE = struct.Struct("<BIII")
_ASSET = struct.Struct("<BIBI")
_PUBLISH = struct.Struct("<BI")
_PLAYBACK = struct.Struct("<BBfBQI")


class ProtocolError(Exception):
    """A frame that does not follow the protocol; the text is for the client's developer."""


class Level(IntEnum):
    """How serious a status is."""

    INFO = 0
    WARNING = 1
    ERROR = 2


@dataclass(frozen=True)
class Publish:
    """A client's message on a channel that it advertised."""

    channel: int
    payload: bytes


@dataclass(frozen=True)
class ServiceRequest:
    """A client's call of a service."""

    service: int
    call: int
    encoding: str
    payload: bytes


@dataclass(frozen=True)
class PlaybackControl:
    """A client's wish to play, pause or seek a recording."""

    playing: bool
    speed: float
    seek: int | None
    request: str


# Binary frames -------------------------------------------------------------------------------------------


def message_frame(subscription: int, nanoseconds: int, payload: bytes) -> bytes:
    """Build a message for one of the client's subscriptions."""
    return _MESSAGE.pack(1, subscription, nanoseconds) + payload


def time_frame(nanoseconds: int) -> bytes:
    """Build the announcement of simulated time."""
    return _TIME.pack(2, nanoseconds)


def service_response_frame(service: int, call: int, payload: bytes, encoding: str = ENCODING) -> bytes:
    """Build the answer to a `ServiceRequest`."""
    name = encoding.encode()
    return _SERVICE.pack(3, service, call, len(name)) + name + payload


def asset_frame(request: int, data: bytes) -> bytes:
    """Build the answer to ``fetchAsset`` that carries the file."""
    return _ASSET.pack(4, request, 0, 0) + data


def asset_error_frame(request: int, reason: str) -> bytes:
    """Build the answer to ``fetchAsset`` that says why there is no file."""
    text = reason.encode()
    return _ASSET.pack(4, request, 1, len(text)) + text


def parse_binary(frame: bytes) -> Publish | ServiceRequest | PlaybackControl:
    """Read a client's binary frame.

    Raises
    ------
    ProtocolError
        When the opcode is unknown or the frame is shorter than it says.
    """
    if not frame:
        raise ProtocolError("empty binary frame")
    match frame[0]:
        case 1:
            _, channel = _unpack(_PUBLISH, frame, "message")
            return Publish(channel, frame[_PUBLISH.size :])
        case 2:
            _, service, call, length = _unpack(_SERVICE, frame, "service request")
            encoding, payload = _text(frame, _SERVICE.size, length, "service request")
            return ServiceRequest(service, call, encoding, payload)
        case 3:
            _, playing, speed, seeks, seek, length = _unpack(_PLAYBACK, frame, "playback control")
            request, _ = _text(frame, _PLAYBACK.size, length, "playback control")
            return PlaybackControl(playing == 0, speed, seek if seeks else None, request)
    raise ProtocolError(f"unknown binary opcode {frame[0]}")


def _unpack(layout: struct.Struct, frame: bytes, what: str) -> tuple[Any, ...]:
    if len(frame) < layout.size:
        raise ProtocolError(f"{what} of {len(frame)} bytes is shorter than its header of {layout.size}")
    return layout.unpack_from(frame)


def _text(frame: bytes, start: int, length: int, what: str) -> tuple[str, bytes]:
    if start + length > len(frame):
        raise ProtocolError(f"{what} promises {length} bytes of text but holds {len(frame) - start}")
    try:
        return frame[start : start + length].decode(), frame[start + length :]
    except UnicodeDecodeError:
        raise ProtocolError(f"{what} holds text that is not UTF-8") from None


# Text frames ---------------------------------------------------------------------------------------------


def parse_text(frame: str) -> dict[str, Any]:
    """Read a client's text frame: a JSON object with a string ``op``.

    Raises
    ------
    ProtocolError
        When it is anything else.
    """
    try:
        message = json.loads(frame)
    except (ValueError, RecursionError) as error:
        raise ProtocolError(f"not JSON: {error}") from None
    if not isinstance(message, dict) or not isinstance(message.get("op"), str):
        raise ProtocolError('expected a JSON object with a string "op"')
    return message


def server_info(name: str, session: str, has_time: bool, metadata: Mapping[str, str]) -> str:
    """Say who the server is and what it can do.

    The ``time`` capability is claimed only once there is a time: clients that see it wait for time frames
    and stand still without them.
    """
    return _dump(
        "serverInfo",
        name=name,
        capabilities=[*CAPABILITIES, *(["time"] if has_time else [])],
        supportedEncodings=[ENCODING],
        metadata=dict(metadata),
        sessionId=session,
    )


def status(level: Level, text: str, identifier: str | None = None) -> str:
    """Tell the client's user something; with an identifier it stays until `remove_status`."""
    return _dump("status", level=int(level), message=text, **({"id": identifier} if identifier else {}))


def remove_status(identifiers: Iterable[str]) -> str:
    """Withdraw statuses."""
    return _dump("removeStatus", statusIds=list(identifiers))


def advertise(channels: Mapping[int, Topic]) -> str:
    """Offer topics under channel numbers."""
    return _dump(
        "advertise",
        channels=[
            {
                "id": number,
                "topic": topic.name,
                "encoding": ENCODING,
                "schemaName": topic.type,
                "schema": topic.schema or "",
                # Left out where nobody knows the definition; an empty one is a message without fields.
                **({} if topic.schema is None else {"schemaEncoding": SCHEMA_ENCODING}),
            }
            for number, topic in channels.items()
        ],
    )


def unadvertise(channels: Iterable[int]) -> str:
    """Withdraw channels."""
    return _dump("unadvertise", channelIds=list(channels))


def advertise_services(services: Mapping[int, Service]) -> str:
    """Offer services under numbers."""
    return _dump(
        "advertiseServices",
        services=[
            {
                "id": number,
                "name": service.name,
                "type": service.type,
                "request": _service_schema(f"{service.type}_Request", service.request_schema),
                "response": _service_schema(f"{service.type}_Response", service.response_schema),
                # Clients of the protocol's first version read only these two.
                "requestSchema": service.request_schema,
                "responseSchema": service.response_schema,
            }
            for number, service in services.items()
        ],
    )


def _service_schema(name: str, schema: str) -> dict[str, str]:
    return {
        "encoding": ENCODING,
        "schemaName": name,
        "schemaEncoding": SCHEMA_ENCODING,
        "schema": schema,
    }


def unadvertise_services(services: Iterable[int]) -> str:
    """Withdraw services."""
    return _dump("unadvertiseServices", serviceIds=list(services))


def service_call_failure(service: int, call: int, reason: str) -> str:
    """Answer a `ServiceRequest` that failed."""
    return _dump("serviceCallFailure", serviceId=service, callId=call, message=reason)


def parameter_values(parameters: Iterable[Parameter], request: str | None = None) -> str:
    """Tell parameters' values, as an answer where a request is named."""
    return _dump(
        "parameterValues",
        parameters=[_parameter(parameter) for parameter in parameters],
        **({"id": request} if request is not None else {}),
    )


def _parameter(parameter: Parameter) -> dict[str, Any]:
    value = parameter.value
    if isinstance(value, bytes):
        return {
            "name": parameter.name,
            "value": base64.b64encode(value).decode(),
            "type": "byte_array",
        }
    if isinstance(value, float):
        return {"name": parameter.name, "value": _number(value), "type": "float64"}
    if isinstance(value, list) and any(isinstance(item, float) for item in value):
        numbers = [_number(float(item)) for item in value]
        return {"name": parameter.name, "value": numbers, "type": "float64_array"}
    return {"name": parameter.name, "value": value} if value is not None else {"name": parameter.name}


def _number(value: float) -> float | str:
    """JSON has no words for what is not finite; Python and JavaScript read these back."""
    if math.isfinite(value):
        return value
    return "NaN" if math.isnan(value) else "Infinity" if value > 0 else "-Infinity"


def parse_parameter(entry: object) -> Parameter:
    """Read one entry of ``setParameters``; a missing value unsets the parameter.

    Raises
    ------
    ProtocolError
        When it has no name, or a value that a ROS parameter can not hold.
    """
    if not isinstance(entry, dict) or not isinstance(entry.get("name"), str):
        raise ProtocolError(f'a parameter needs a string "name": {entry!r}')
    name: str = entry["name"]
    value: Any = entry.get("value")
    kind = entry.get("type")
    try:
        if kind == "byte_array":
            return Parameter(name, base64.b64decode(value, validate=True))
        if kind == "float64":
            return Parameter(name, float(value))
        if kind == "float64_array":
            return Parameter(name, [float(item) for item in value])
    except (TypeError, ValueError):
        raise ProtocolError(f"parameter {name}: {value!r} is no {kind}") from None
    if not _is_parameter_value(value):
        raise ProtocolError(f"parameter {name}: ROS parameters can not hold {value!r}")
    return Parameter(name, value)


def _is_parameter_value(value: object) -> bool:
    if isinstance(value, list):
        kinds = {type(item) for item in value}
        return kinds <= {bool} or kinds <= {int} or kinds <= {int, float} or kinds <= {str}
    return value is None or isinstance(value, bool | int | float | str)


def connection_graph_update(before: Graph, after: Graph) -> str | None:
    """Tell what changed between two graphs; None where nothing did."""
    topics = before.publishers.keys() | before.subscribers.keys()
    topics_now = after.publishers.keys() | after.subscribers.keys()
    changes: dict[str, list[Any]] = {
        "publishedTopics": _changed(before.publishers, after.publishers, "publisherIds"),
        "subscribedTopics": _changed(before.subscribers, after.subscribers, "subscriberIds"),
        "advertisedServices": _changed(before.services, after.services, "providerIds"),
        "removedTopics": sorted(topics - topics_now),
        "removedServices": sorted(before.services.keys() - after.services.keys()),
    }
    return _dump("connectionGraphUpdate", **changes) if any(changes.values()) else None


def _changed(
    before: Mapping[str, frozenset[str]], after: Mapping[str, frozenset[str]], key: str
) -> list[dict[str, Any]]:
    gone = {name: frozenset[str]() for name in before.keys() - after.keys()}
    return [
        {"name": name, key: sorted(nodes)}
        for name, nodes in sorted({**after, **gone}.items())
        if before.get(name, frozenset()) != nodes
    ]


def full_type_name(name: str) -> str:
    """Spell a message type in full: clients leave ``/msg/`` out or put it in."""
    parts = name.split("/")
    return f"{parts[0]}/msg/{parts[1]}" if len(parts) == 2 else name


def _dump(op: str, **fields: Sequence[Any] | Mapping[str, Any] | ParameterValue) -> str:
    return json.dumps({"op": op, **fields}, separators=(",", ":"))
