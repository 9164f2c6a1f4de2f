"""Attachment of rmw_zenoh to samples, requests and replies: sequence number, time and gid."""

from __future__ import annotations

import struct
from typing import Any

_ATTACHMENT = struct.Struct("<qqB16s")
"""Sequence number, source time in ns, length of the gid, gid."""
_GID_LENGTH = 16


def pack(sequence: int, stamp_ns: int, gid: bytes) -> bytes:
    """Return an attachment's bytes."""
    return _ATTACHMENT.pack(sequence, stamp_ns, _GID_LENGTH, gid)


def read(attachment: Any) -> tuple[int, int, bytes]:
    """Return (sequence, source time, gid); zeros for samples without a valid attachment."""
    data = attachment.to_bytes() if attachment is not None else b""
    if len(data) != _ATTACHMENT.size:
        return 0, 0, bytes(_GID_LENGTH)
    sequence, stamp, _, gid = _ATTACHMENT.unpack(data)
    return sequence, stamp, gid
