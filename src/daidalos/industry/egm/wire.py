"""Protocol buffers' wire format for dataclasses whose fields say their number and kind.

Only what EGM's messages use: numbers without sign, doubles, nested messages and repeated doubles. Unknown fields are
skipped, as the format asks; what is cut off, or lacks a field that has to be there, is refused.
"""

from __future__ import annotations

import dataclasses
import struct
from typing import Any, TypeVar, get_args, get_type_hints

T = TypeVar("T")

_VARINT, _FIXED64, _BYTES, _FIXED32 = 0, 1, 2, 5
_MAX_VARINT = 10
_MAX_DEPTH = 8


class WireError(ValueError):
    """Bytes that are no such message."""


def wire(number: int, *, is_required: bool = False, default: Any = None) -> Any:
    """Return a dataclass field with its number; an optional one is None where it is absent, a repeated one empty."""
    metadata = {"number": number, "is_required": is_required}
    if is_required:
        return dataclasses.field(metadata=metadata)
    return dataclasses.field(default=default, metadata=metadata)


@dataclasses.dataclass(frozen=True)
class _Field:
    name: str
    number: int
    is_required: bool
    kind: type
    is_repeated: bool


_KNOWN: dict[type, dict[int, _Field]] = {}


def _fields(type_: type) -> dict[int, _Field]:
    if type_ in _KNOWN:
        return _KNOWN[type_]
    hints: dict[str, Any] = get_type_hints(type_)
    found = {}
    for one in dataclasses.fields(type_):
        hint = hints[one.name]
        is_repeated = getattr(hint, "__origin__", None) is tuple
        options = [kind for kind in get_args(hint) if kind not in (type(None), Ellipsis)] or [hint]
        number = one.metadata["number"]
        found[number] = _Field(one.name, number, one.metadata["is_required"], options[0], is_repeated)
    _KNOWN[type_] = found
    return found


def encode(message: Any) -> bytes:
    """Return the bytes of a message."""
    out = bytearray()
    for field in _fields(type(message)).values():
        value = getattr(message, field.name)
        if value is None:
            continue
        for one in value if field.is_repeated else (value,):
            _write(out, field, one)
    return bytes(out)


def _write(out: bytearray, field: _Field, value: Any) -> None:
    if field.kind is float:
        _write_varint(out, field.number << 3 | _FIXED64)
        out += struct.pack("<d", value)
    elif dataclasses.is_dataclass(field.kind):
        body = encode(value)
        _write_varint(out, field.number << 3 | _BYTES)
        _write_varint(out, len(body))
        out += body
    else:
        if int(value) < 0:
            raise ValueError(f"{field.name} is {value}, but must not be negative")
        _write_varint(out, field.number << 3 | _VARINT)
        _write_varint(out, int(value))


def _write_varint(out: bytearray, value: int) -> None:
    while value > 0x7F:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    out.append(value)


def decode(type_: type[T], data: bytes, depth: int = 0) -> T:
    """Return the message that bytes are.

    Raises
    ------
    WireError
        Where they are none of this type.
    """
    if depth > _MAX_DEPTH:
        raise WireError("messages are nested too deeply")
    fields = _fields(type_)
    values: dict[str, Any] = {}
    place = 0
    while place < len(data):
        tag, place = _read_varint(data, place)
        number, kind = tag >> 3, tag & 7
        raw, place = _read_raw(data, place, kind)
        field = fields.get(number)
        if field is None:
            continue
        _take(values, field, kind, raw, depth)
    for field in fields.values():
        if field.is_required and field.name not in values:
            raise WireError(f"{type_.__name__} has no {field.name}")
    return type_(**values)


def _read_raw(data: bytes, place: int, kind: int) -> tuple[int | bytes, int]:
    if kind == _VARINT:
        return _read_varint(data, place)
    if kind == _BYTES:
        length, place = _read_varint(data, place)
    elif kind in (_FIXED64, _FIXED32):
        length = 8 if kind == _FIXED64 else 4
    else:
        raise WireError(f"a field of the unknown kind {kind}")
    if length > len(data) - place:
        raise WireError(f"a field of {length} bytes is cut off after {len(data) - place}")
    return data[place : place + length], place + length


def _read_varint(data: bytes, place: int) -> tuple[int, int]:
    value = 0
    for k in range(_MAX_VARINT):
        if place + k >= len(data):
            raise WireError("a number is cut off")
        byte = data[place + k]
        value |= (byte & 0x7F) << 7 * k
        if byte < 0x80:
            return value & 0xFFFFFFFFFFFFFFFF, place + k + 1
    raise WireError(f"a number of more than {_MAX_VARINT} bytes")


def _take(values: dict[str, Any], field: _Field, kind: int, raw: int | bytes, depth: int) -> None:
    """Keep a field's value."""
    if field.kind is float and isinstance(raw, bytes) and (kind == _FIXED64 or field.is_repeated):
        if kind not in (_FIXED64, _BYTES) or len(raw) % 8:
            raise WireError(f"{field.name} has {len(raw)} bytes, which are no doubles")
        numbers = struct.unpack(f"<{len(raw) // 8}d", raw)
        values[field.name] = (*values.get(field.name, ()), *numbers) if field.is_repeated else numbers[0]
    elif dataclasses.is_dataclass(field.kind) and kind == _BYTES and isinstance(raw, bytes):
        values[field.name] = decode(field.kind, raw, depth + 1)
    elif field.kind in (int, bool) and isinstance(raw, int):
        values[field.name] = field.kind(raw)
    else:
        raise WireError(f"{field.name} is of the kind {kind}, which does not fit")
