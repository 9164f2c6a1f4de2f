"""The binary frames of the Foxglove WebSocket protocol: an opcode, little-endian fields, then bytes or text."""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

from daidalos.studio.protocol import ENCODING, ProtocolError


class Layout:
    """The fixed part at the beginning of a frame.

    Parameters
    ----------
    name
        What the frame is called in errors.
    opcode
        The first byte.
    **fields
        The fields after it, each with its code of `struct`.
    """

    def __init__(self, name: str, opcode: int, **fields: str) -> None:
        self.opcode = opcode
        self._name = name
        self._struct = struct.Struct("<B" + "".join(fields.values()))
        # Returns the bytes of the opcode and the fields; every message to a client passes here.
        self.pack: Callable[..., bytes] = partial(self._struct.pack, opcode)
        self.offsets: dict[str, int] = {}
        offset = 1
        for field, code in fields.items():
            self.offsets[field] = offset
            offset += struct.calcsize(f"<{code}")

    @property
    def size(self) -> int:
        """Bytes of the opcode and the fields."""
        return self._struct.size

    def unpack(self, frame: bytes) -> tuple[Any, ...]:
        """Return the values of the fields.

        Raises
        ------
        ProtocolError
            When the frame is shorter than its fixed part.
        """
        if len(frame) < self.size:
            raise ProtocolError(f"{self._name} of {len(frame)} bytes is shorter than its header of {self.size}")
        return self._struct.unpack_from(frame)[1:]

    def text(self, frame: bytes, length: int) -> tuple[str, bytes]:
        """Return the text of `length` bytes after the fixed part, and what follows it.

        Raises
        ------
        ProtocolError
            When the frame is shorter, or the text is not valid UTF-8.
        """
        rest = frame[self.size :]
        if length > len(rest):
            raise ProtocolError(f"{self._name} promises {length} bytes of text but holds {len(rest)}")
        try:
            return rest[:length].decode(), rest[length:]
        except UnicodeDecodeError:
            raise ProtocolError(f"{self._name} holds text that is not valid UTF-8") from None


MESSAGE = Layout("message", 1, subscription="I", time="Q")
TIME = Layout("time", 2, time="Q")
SERVICE_RESPONSE = Layout("service response", 3, service="I", call="I", length="I")
ASSET = Layout("asset", 4, request="I", status="B", length="I")
SERVER_LAYOUTS = {"MESSAGE": MESSAGE, "TIME": TIME, "SERVICE_RESPONSE": SERVICE_RESPONSE, "ASSET": ASSET}

PUBLISH = Layout("message", 1, channel="I")
SERVICE_REQUEST = Layout("service request", 2, service="I", call="I", length="I")
PLAYBACK_CONTROL = Layout("playback control", 3, state="B", speed="f", seeks="B", seek="Q", length="I")
CLIENT_LAYOUTS = {"PUBLISH": PUBLISH, "SERVICE_REQUEST": SERVICE_REQUEST, "PLAYBACK_CONTROL": PLAYBACK_CONTROL}


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
    """A client's request to play, pause or seek a recording."""

    playing: bool
    speed: float
    seek: int | None
    request: str


def message_frame(subscription: int, nanoseconds: int, payload: bytes) -> bytes:
    """Build a message for one of the client's subscriptions."""
    return MESSAGE.pack(subscription, nanoseconds) + payload


def time_frame(nanoseconds: int) -> bytes:
    """Build the announcement of simulated time."""
    return TIME.pack(nanoseconds)


def service_response_frame(service: int, call: int, payload: bytes, encoding: str = ENCODING) -> bytes:
    """Build the answer to a `ServiceRequest`."""
    name = encoding.encode()
    return SERVICE_RESPONSE.pack(service, call, len(name)) + name + payload


def asset_head(request: int) -> bytes:
    """Return the head of the answer to ``fetchAsset`` that carries the file: the file's bytes follow."""
    return ASSET.pack(request, 0, 0)


def asset_error_frame(request: int, reason: str) -> bytes:
    """Build the answer to ``fetchAsset`` that says why there is no file."""
    text = reason.encode()
    return ASSET.pack(request, 1, len(text)) + text


def parse_binary(frame: bytes) -> Publish | ServiceRequest | PlaybackControl:
    """Read a client's binary frame.

    Raises
    ------
    ProtocolError
        When the opcode is unknown or the frame is shorter than it says.
    """
    if not frame:
        raise ProtocolError("empty binary frame")
    if frame[0] == PUBLISH.opcode:
        (channel,) = PUBLISH.unpack(frame)
        return Publish(channel, frame[PUBLISH.size :])
    if frame[0] == SERVICE_REQUEST.opcode:
        service, call, length = SERVICE_REQUEST.unpack(frame)
        return ServiceRequest(service, call, *SERVICE_REQUEST.text(frame, length))
    if frame[0] == PLAYBACK_CONTROL.opcode:
        state, speed, seeks, seek, length = PLAYBACK_CONTROL.unpack(frame)
        request, _ = PLAYBACK_CONTROL.text(frame, length)
        return PlaybackControl(state == 0, speed, seek if seeks else None, request)
    raise ProtocolError(f"unknown binary opcode {frame[0]}")
