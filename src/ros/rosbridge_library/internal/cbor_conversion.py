"""Messages as values for CBOR: arrays of numbers are bytes with a tag of RFC 8746."""

from __future__ import annotations

import re
import struct
from typing import Any

from rosbridge_library.util.cbor import Tag

_NUMBERS = {
    "uint16": (69, "<{}H"),
    "uint32": (70, "<{}I"),
    "uint64": (71, "<{}Q"),
    "byte": (72, "{}b"),
    "int8": (72, "{}b"),
    "int16": (77, "<{}h"),
    "int32": (78, "<{}i"),
    "int64": (79, "<{}q"),
    "float": (85, "<{}f"),
    "double": (86, "<{}d"),
}
TAGGED_ARRAY_FORMATS = {f"sequence<{name}>": tagged for name, tagged in _NUMBERS.items()}
"""Tag and layout, as for `struct`, of arrays of numbers."""
_BYTES = {"uint8", "char", "octet"}
_ELEMENT = re.compile(r"sequence<([^,]+?(?:<\d+>)?)(?:, *\d+)?>|(.+)\[\d+\]")


def extract_cbor_values(msg: Any) -> dict[str, Any]:
    """Return the fields of a message as values for CBOR."""
    return {name: _value(getattr(msg, name), kind) for name, kind in msg.get_fields_and_field_types().items()}


def _value(value: Any, kind: str) -> Any:
    many = _ELEMENT.fullmatch(kind)
    if many is not None:
        return _values(value, many[1] or many[2])
    if isinstance(value, bytes):
        return value[0]
    if isinstance(value, str | bool | int | float):
        return value
    return extract_cbor_values(value)


def _values(values: Any, kind: str) -> Any:
    if kind in _BYTES:
        return b"".join(values) if kind == "octet" else bytes(values)
    if kind in _NUMBERS:
        tag, layout = _NUMBERS[kind]
        return Tag(tag, struct.pack(layout.format(len(values)), *values))
    return [_value(one, kind) for one in values]
