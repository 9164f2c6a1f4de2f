"""Packets of Art-Net 4: DMX levels, and the poll by which controllers and nodes find each other.

Source: Art-Net 4 protocol release, Artistic Licence. Numbers are big-endian except operation codes and ports.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass

PORT = 6454
ID = b"Art-Net\0"
VERSION = 14
OP_POLL, OP_POLL_REPLY, OP_DMX = 0x2000, 0x2100, 0x5000
MAX_UNIVERSE = 0x7FFF
KEEP_ALIVE_S = 0.9
"""Time after which unchanged levels are sent again; the protocol asks for 0.8 s to 1 s."""

_STYLE_CONTROLLER = 0x01
_REPLY_BYTES = 239


class PacketError(ValueError):
    """Error of data that is no packet of the expected kind, or of levels that fit no packet."""


@dataclass(frozen=True)
class Dmx:
    """Content of an ArtDmx packet.

    Attributes
    ----------
    universe : int
        Port-Address: net in bits 14 to 8, sub-net in bits 7 to 4, universe in bits 3 to 0.
    sequence : int
        From 1 to 255 in turn; 0 where the order is not watched.
    data : bytes
        Levels of 2 to 512 slots.
    physical : int
        Number of the input port, for information only.
    """

    universe: int
    sequence: int
    data: bytes
    physical: int = 0


def dmx_packet(universe: int, sequence: int, data: bytes, physical: int = 0) -> bytes:
    """Return an ArtDmx packet; an odd number of slots is filled up with one of 0, as the protocol asks.

    Raises
    ------
    PacketError
        When the universe or the number of slots is out of range.
    """
    if not 0 <= universe <= MAX_UNIVERSE:
        raise PacketError(f"the universe of Art-Net must be from 0 to {MAX_UNIVERSE}, got {universe}")
    if not 1 <= len(data) <= 512:
        raise PacketError(f"there must be 1 to 512 slots, got {len(data)}")
    levels = data + b"\0" * (len(data) % 2)
    head = struct.pack("<8sH", ID, OP_DMX)
    return (
        head + struct.pack(">HBBBBH", VERSION, sequence, physical, universe & 0xFF, universe >> 8, len(levels)) + levels
    )


def parse_dmx(packet: bytes) -> Dmx:
    """Return the content of an ArtDmx packet.

    Raises
    ------
    PacketError
        When it is none.
    """
    if operation(packet) != OP_DMX or len(packet) < 18:
        raise PacketError("is no ArtDmx packet")
    version, sequence, physical, low, net, length = struct.unpack(">HBBBBH", packet[10:18])
    data = packet[18 : 18 + length]
    if version < VERSION or not 2 <= length <= 512 or len(data) != length:
        raise PacketError(f"is an ArtDmx packet of version {version} with {len(data)} of {length} slots")
    return Dmx((net & 0x7F) << 8 | low, sequence, data, physical)


def operation(packet: bytes) -> int | None:
    """Return the operation code of an Art-Net packet, None for anything else."""
    if len(packet) < 10 or packet[:8] != ID:
        return None
    return int.from_bytes(packet[8:10], "little")


def is_poll(packet: bytes) -> bool:
    """Return whether a packet is an ArtPoll of this version or a later one."""
    return operation(packet) == OP_POLL and len(packet) >= 14 and int.from_bytes(packet[10:12], "big") >= VERSION


def poll_packet() -> bytes:
    """Return an ArtPoll packet that asks for no diagnostics."""
    return struct.pack("<8sH", ID, OP_POLL) + struct.pack(">HBB", VERSION, 0, 0)


def poll_reply(address: str, universe: int, bind_index: int, short_name: str, long_name: str, report: str) -> bytes:
    """Return an ArtPollReply of a controller that sends one universe; several universes reply one by one.

    Parameters
    ----------
    address : str
        The sender's address, such as ``192.168.1.5``.
    universe : int
        Port-Address of what is sent.
    bind_index : int
        Number of this reply, from 1.
    short_name, long_name : str
        Names of the controller.
    report : str
        State in words, after the code ``#0001`` for "powered up and well" and the count of replies.
    """
    address_bytes = bytes(int(part) for part in address.split("."))
    port_types = bytes([0x40, 0, 0, 0])  # a port that puts DMX512 on the network
    good_input = bytes([0x80, 0, 0, 0])  # data received
    sw_in = bytes([universe & 0x0F, 0, 0, 0])
    packet = b"".join(
        (
            struct.pack("<8sH", ID, OP_POLL_REPLY),
            address_bytes,
            struct.pack("<H", PORT),
            struct.pack(">HBBHBB", 1, universe >> 8, universe >> 4 & 0x0F, 0x00FF, 0, 0xD0),
            struct.pack("<H", 0x7FF0),  # the manufacturer's code, of the range for prototypes
            _text(short_name, 18),
            _text(long_name, 64),
            _text(f"#0001 [{bind_index:04d}] {report}", 64),
            struct.pack(">H", 1),
            port_types,
            good_input,
            bytes(4),
            sw_in,
            bytes(4),
            bytes(6),  # priority of sACN, macros, remote keys, spare
            bytes([_STYLE_CONTROLLER]),
            bytes(6),  # MAC address, not known
            address_bytes,
            bytes([bind_index, 0x08]),  # 15-bit Port-Addresses
        )
    )
    return packet.ljust(_REPLY_BYTES, b"\0")


def _text(text: str, size: int) -> bytes:
    """Return ASCII text in a field, cut so that a zero ends it."""
    return text.encode("ascii", "replace")[: size - 1].ljust(size, b"\0")
