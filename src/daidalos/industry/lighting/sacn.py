"""Packets of streaming ACN (ANSI E1.31-2018): DMX levels and the list of a sender's universes, big-endian."""

from __future__ import annotations

import struct
from dataclasses import dataclass

from daidalos.industry.lighting.artnet import PacketError

PORT = 5568
ID = b"ASC-E1.17\0\0\0"
MIN_UNIVERSE, MAX_UNIVERSE = 1, 63999
DISCOVERY_UNIVERSE = 64214
DISCOVERY_S = 10.0
KEEP_ALIVE_S = 0.9
"""Time after which unchanged levels are sent again; the standard asks for 0.8 s to 1 s."""
REPEATS = 3
"""Packets with the same levels before they are sent less often."""
DEFAULT_PRIORITY = 100

_ROOT_DATA, _ROOT_EXTENDED = 4, 8
_FRAME_DATA, _FRAME_DISCOVERY = 2, 2
_DMP_SET_PROPERTY, _DISCOVERY_LIST = 2, 1
_TERMINATED, _PREVIEW = 0x40, 0x80
_PER_PAGE = 512


@dataclass(frozen=True)
class Data:
    """Content of a data packet."""

    universe: int
    sequence: int
    data: bytes
    cid: bytes
    source: str
    priority: int
    is_terminated: bool
    is_preview: bool


def multicast_address(universe: int) -> str:
    """Return the IPv4 multicast address of a universe."""
    return f"239.255.{universe >> 8}.{universe & 0xFF}"


def data_packet(
    universe: int,
    sequence: int,
    data: bytes,
    cid: bytes,
    source: str,
    priority: int = DEFAULT_PRIORITY,
    *,
    is_terminated: bool = False,
    is_preview: bool = False,
) -> bytes:
    """Return a data packet with the start code 0.

    Parameters
    ----------
    universe : int
        From 1 to 63999.
    sequence : int
        From 0 to 255 in turn, each universe by itself.
    data : bytes
        Levels of up to 512 slots.
    cid : bytes
        The sender's identifier, 16 bytes that stay the same.
    source : str
        The sender's name, cut to 63 bytes of UTF-8.
    priority : int
        From 0 to 200.
    is_terminated : bool
        Whether the sender sends no more to the universe.
    is_preview : bool
        Whether the levels are for displays only.

    Raises
    ------
    PacketError
        When a value is out of range.
    """
    if not MIN_UNIVERSE <= universe <= MAX_UNIVERSE:
        raise PacketError(f"the universe of sACN must be from {MIN_UNIVERSE} to {MAX_UNIVERSE}, got {universe}")
    if not 0 <= priority <= 200:
        raise PacketError(f"the priority of sACN must be from 0 to 200, got {priority}")
    if len(data) > 512:
        raise PacketError(f"there must be at most 512 slots, got {len(data)}")
    options = _TERMINATED * is_terminated | _PREVIEW * is_preview
    properties = struct.pack(">BBHHHB", _DMP_SET_PROPERTY, 0xA1, 0, 1, 1 + len(data), 0) + data
    dmp = _length(properties) + properties
    frame = struct.pack(">I64sBHBBH", _FRAME_DATA, _text(source), priority, 0, sequence, options, universe) + dmp
    return _root(_ROOT_DATA, cid, frame)


def parse_data(packet: bytes) -> Data:
    """Return the content of a data packet.

    Raises
    ------
    PacketError
        When it is none with the start code 0.
    """
    if len(packet) < 126 or packet[:16] != struct.pack(">HH", 16, 0) + ID or packet[18:22] != b"\0\0\0\4":
        raise PacketError("is no data packet of sACN")
    vector, name, priority, _, sequence, options, universe = struct.unpack(">I64sBHBBH", packet[40:115])
    dmp, kind, first, step, count, code = struct.unpack(">BBHHHB", packet[117:126])
    data = packet[126 : 125 + count]
    if (vector, dmp, kind, first, step, code) != (_FRAME_DATA, _DMP_SET_PROPERTY, 0xA1, 0, 1, 0):
        raise PacketError("is no data packet of sACN with the start code 0")
    if len(data) != count - 1:
        raise PacketError(f"has {len(data)} of {count - 1} slots")
    text = name.split(b"\0", 1)[0].decode("utf-8", "replace")
    is_terminated, is_preview = bool(options & _TERMINATED), bool(options & _PREVIEW)
    return Data(universe, sequence, data, packet[22:38], text, priority, is_terminated, is_preview)


def discovery_packets(universes: list[int], cid: bytes, source: str) -> list[bytes]:
    """Return the packets that list a sender's universes, in ascending order, 512 to a page."""
    found = sorted(set(universes))
    pages = [found[start : start + _PER_PAGE] for start in range(0, len(found), _PER_PAGE)] or [[]]
    packets = []
    for number, page in enumerate(pages):
        head = struct.pack(">IBB", _DISCOVERY_LIST, number, len(pages) - 1)
        content = head + b"".join(universe.to_bytes(2, "big") for universe in page)
        frame = struct.pack(">I64sI", _FRAME_DISCOVERY, _text(source), 0) + _length(content) + content
        packets.append(_root(_ROOT_EXTENDED, cid, frame))
    return packets


def _root(vector: int, cid: bytes, frame: bytes) -> bytes:
    layer = _length(frame) + frame
    content = struct.pack(">I16s", vector, cid) + layer
    return struct.pack(">HH12s", 16, 0, ID) + _length(content) + content


def _length(content: bytes) -> bytes:
    """Return flags and length of a layer, which count themselves."""
    return struct.pack(">H", 0x7000 | len(content) + 2)


def _text(source: str) -> bytes:
    """Return a name in UTF-8, cut between characters so that a zero ends it."""
    return source.encode("utf-8")[:63].decode("utf-8", "ignore").encode("utf-8")
