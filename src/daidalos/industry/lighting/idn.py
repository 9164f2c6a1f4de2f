"""Packets of the ILDA Digital Network (IDN): frames of a laser projector over UDP.

Sources: ILDA, IDN-Stream specification, revision 002 (channel messages, configuration, samples of laser graphics); the
four-byte header before them is IDN-Hello's. Numbers are big-endian.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.industry.lighting.artnet import PacketError

PORT = 7255
MAX_MESSAGE = 0xFF00
"""Longest message [bytes]; a frame that needs more would have to be sent in fragments."""

TIMEOUT_S = 1.0
"""Time without packets after which a projector ends the connection and goes dark."""

MESSAGE, CLOSE = 0x40, 0x44
_IS_CHANNEL, _HAS_CONFIGURATION = 0x8000, 0x4000
_VOID, _FRAME = 0x00, 0x02
_ROUTING, _CLOSE_CHANNEL = 0x01, 0x02
_DISCRETE_GRAPHIC = 0x02
_PRECISION, _PADDING = 0x4010, 0x0000
_X, _Y, _RED, _GREEN, _BLUE = 0x4200, 0x4210, 0x527E, 0x5214, 0x51CC
_TAGS = (_X, _PRECISION, _Y, _PRECISION, _RED, _GREEN, _BLUE, _PADDING)
_SAMPLE = np.dtype([("place", ">i2", 2), ("color", "u1", 3)])
_HELLO, _CHANNEL, _CONFIGURATION, _CHUNK = "> B B H", "> H H I", "> B B B B", "> I"
MAX_SAMPLES = (MAX_MESSAGE - 32) // _SAMPLE.itemsize


@dataclass(frozen=True)
class Frame:
    """Picture that a projector draws again and again.

    Attributes
    ----------
    places : (n, 2) array
        Deflections of the beam, x to the right and y up, from -1 to 1. From the first of them the beam starts dark.
    colors : (n, 3) array of uint8
        Red, green and blue on the way to each place.
    duration : float
        Time of one pass [s].
    """

    places: NDArray[np.float64]
    colors: NDArray[np.uint8]
    duration: float


def frame_packet(frame: Frame, sequence: int, timestamp_us: int) -> bytes:
    """Return the packet of a frame, with the configuration that describes its samples.

    Parameters
    ----------
    frame : Frame
        Without samples, the projector goes dark.
    sequence : int
        Number of the packet, modulo 65536.
    timestamp_us : int
        Time of the frame [us], modulo 2**32.

    Raises
    ------
    PacketError
        When there are too many samples, the frame takes more than 16 s, or a deflection is out of range.
    """
    count = len(frame.places)
    duration_us = round(frame.duration * 1e6)
    if count > MAX_SAMPLES or not 0 <= duration_us < 1 << 24:
        raise PacketError(f"a frame has at most {MAX_SAMPLES} samples in 16 s, got {count} in {frame.duration:g} s")
    if not (np.abs(frame.places) <= 1.0).all():
        raise PacketError("deflections must be from -1 to 1")
    samples = np.zeros(count, _SAMPLE)
    samples["place"] = np.rint(frame.places * 0x7FFF)
    samples["color"] = frame.colors
    configuration = struct.pack(_CONFIGURATION, len(_TAGS) // 2, _ROUTING, 0, _DISCRETE_GRAPHIC)
    tags = struct.pack(f">{len(_TAGS)}H", *_TAGS)
    body = configuration + tags + struct.pack(_CHUNK, duration_us) + samples.tobytes()
    return _packet(MESSAGE, _FRAME, body, sequence, timestamp_us)


def close_packet(sequence: int, timestamp_us: int) -> bytes:
    """Return the packet that closes the channel and the connection; the projector goes dark at once."""
    body = struct.pack(_CONFIGURATION, 0, _CLOSE_CHANNEL, 0, 0)
    return _packet(CLOSE, _VOID, body, sequence, timestamp_us)


def parse_packet(packet: bytes) -> Frame | None:
    """Return the frame of a packet, or None of one that closes the channel or the connection.

    Only frames whose samples have 16-bit places and 8-bit red, green and blue are understood, those of `frame_packet`.

    Raises
    ------
    PacketError
        When it is anything else.
    """
    if len(packet) < 4 or packet[0] not in (MESSAGE, CLOSE):
        raise PacketError("is no IDN packet with a channel message")
    if len(packet) == 4 and packet[0] == CLOSE:
        return None
    if len(packet) < 16:
        raise PacketError("ends within its headers")
    size, content, _ = struct.unpack_from(_CHANNEL, packet, 4)
    if size != len(packet) - 4 or not content & _IS_CHANNEL or not content & _HAS_CONFIGURATION:
        raise PacketError(f"is a message of {size} bytes in {len(packet) - 4}, or without a configuration")
    words, flags, _, mode = struct.unpack_from(_CONFIGURATION, packet, 12)
    if flags & _CLOSE_CHANNEL:
        return None
    start = 16 + 4 * words
    if content & 0xFF != _FRAME or mode != _DISCRETE_GRAPHIC or len(packet) < start + 4:
        raise PacketError("is no whole frame of laser graphics")
    if packet[16:start] != struct.pack(f">{len(_TAGS)}H", *_TAGS):
        raise PacketError("has samples of another kind than 16-bit x and y with 8-bit red, green and blue")
    (duration_us,) = struct.unpack_from(_CHUNK, packet, start)
    if (len(packet) - start - 4) % _SAMPLE.itemsize:
        raise PacketError("ends within a sample")
    samples = np.frombuffer(packet, _SAMPLE, offset=start + 4)
    places = np.maximum(samples["place"].astype(np.float64) / 0x7FFF, -1.0)
    return Frame(places, np.array(samples["color"]), (duration_us & 0xFFFFFF) * 1e-6)


def _packet(command: int, chunk: int, body: bytes, sequence: int, timestamp_us: int) -> bytes:
    hello = struct.pack(_HELLO, command, 0, sequence & 0xFFFF)
    content = _IS_CHANNEL | _HAS_CONFIGURATION | chunk
    return hello + struct.pack(_CHANNEL, 8 + len(body), content, timestamp_us & 0xFFFFFFFF) + body
