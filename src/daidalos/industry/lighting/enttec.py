"""Frames of the DMX USB Pro widget (ENTTEC's API 1.44), which many USB to DMX interfaces speak."""

from __future__ import annotations

import struct

from daidalos.industry.lighting.artnet import PacketError

START, END = 0x7E, 0xE7
SEND_DMX = 6
MIN_SLOTS, MAX_SLOTS = 24, 512
BAUD = 57600
"""Any rate will do: the widget's serial port exists on USB only."""


def dmx_frame(data: bytes) -> bytes:
    """Return the message "output only send DMX", with the start code 0 and at least 24 slots.

    Raises
    ------
    PacketError
        With more than 512 slots.
    """
    if len(data) > MAX_SLOTS:
        raise PacketError(f"there must be at most {MAX_SLOTS} slots, got {len(data)}")
    content = b"\0" + data.ljust(MIN_SLOTS, b"\0")
    return struct.pack("<BBH", START, SEND_DMX, len(content)) + content + bytes([END])


def parse_frame(frame: bytes) -> tuple[int, bytes]:
    """Return the label and the content of a message.

    Raises
    ------
    PacketError
        When it is none.
    """
    if len(frame) < 5 or frame[0] != START or frame[-1] != END:
        raise PacketError("is no message of a DMX USB Pro widget")
    label, length = struct.unpack("<BH", frame[1:4])
    if length != len(frame) - 5:
        raise PacketError(f"has {len(frame) - 5} of {length} bytes")
    return label, frame[4:-1]
