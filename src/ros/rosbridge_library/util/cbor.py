"""Encoder of CBOR (RFC 8949) for values of messages."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import Any

_UNSIGNED, _NEGATIVE, _BYTES, _TEXT, _ARRAY, _MAP, _TAG = range(7)
_FALSE, _TRUE, _NULL, _FLOAT64 = b"\xf4", b"\xf5", b"\xf6", 0xFB
_SIZES = ((24, 1 << 8, ">BB"), (25, 1 << 16, ">BH"), (26, 1 << 32, ">BI"), (27, 1 << 64, ">BQ"))


@dataclass(frozen=True)
class Tag:
    """Value with a tag, such as the bytes of an array of numbers (RFC 8746)."""

    tag: int
    value: Any


def dumps(value: Any) -> bytes:
    """Return a value encoded.

    Raises
    ------
    TypeError, OverflowError
        For a value that is no text, bytes, number, truth value, None, list, mapping or `Tag`, and an integer of more
        than 64 bits.
    """
    parts: list[bytes] = []
    _add(value, parts)
    return b"".join(parts)


def _head(kind: int, number: int) -> bytes:
    if number < 24:
        return bytes([kind << 5 | number])
    for code, limit, layout in _SIZES:
        if number < limit:
            return struct.pack(layout, kind << 5 | code, number)
    raise OverflowError(f"{number} has more than 64 bits")


def _add(value: Any, parts: list[bytes]) -> None:
    if value is None or isinstance(value, bool):
        parts.append(_NULL if value is None else _TRUE if value else _FALSE)
    elif isinstance(value, int):
        parts.append(_head(_UNSIGNED, value) if value >= 0 else _head(_NEGATIVE, -1 - value))
    elif isinstance(value, float):
        parts.append(struct.pack(">Bd", _FLOAT64, value))
    elif isinstance(value, str):
        text = value.encode()
        parts += (_head(_TEXT, len(text)), text)
    elif isinstance(value, bytes | bytearray | memoryview):
        parts += (_head(_BYTES, len(value)), bytes(value))
    elif isinstance(value, list | tuple):
        parts.append(_head(_ARRAY, len(value)))
        for item in value:
            _add(item, parts)
    elif isinstance(value, dict):
        parts.append(_head(_MAP, len(value)))
        for name, item in value.items():
            _add(name, parts)
            _add(item, parts)
    elif isinstance(value, Tag):
        parts.append(_head(_TAG, value.tag))
        _add(value.value, parts)
    else:
        raise TypeError(f"cannot encode a value of type {type(value).__name__}")
