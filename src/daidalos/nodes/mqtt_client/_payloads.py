"""Payloads of MQTT messages: single values as text, JSON, and CDR behind the time of sending."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable
from typing import Any

import numpy as np
from builtin_interfaces.msg import Time
from rclpy.serialization import deserialize_message, serialize_message
from rosidl_runtime_py.convert import message_to_ordereddict
from rosidl_runtime_py.set_message import set_message_fields

from daidalos.interfaces.codec import CdrError

STAMP_LENGTH = len(serialize_message(Time()))
_INTEGERS = ("Char", "UInt8", "UInt16", "UInt32", "UInt64", "Int8", "Int16", "Int32", "Int64")
_INTEGER = re.compile(r"[+-]?[0-9]+")
_FLOAT = re.compile(r"[+-]?([0-9]+\.?[0-9]*([eE][+-]?[0-9]+)?|\.[0-9]+([eE][+-]?[0-9]+)?|inf(inity)?|nan)", re.I)


class PayloadError(ValueError):
    """Payload that does not fit the type; the message continues "cannot read the message:"."""


def primitive_text(type_name: str, message: Any) -> bytes:
    """Return the only value of a message of ``std_msgs`` as text.

    Raises
    ------
    PayloadError
        When messages of the type have no single value.
    """
    kind = _short(type_name)
    if kind == "Bool":
        return b"true" if message.data else b"false"
    if kind in _INTEGERS:
        return str(message.data).encode()
    if kind in ("Float32", "Float64"):
        return str((np.float32 if kind == "Float32" else np.float64)(message.data)).encode()
    if kind == "String":
        return bytes(message.data, "utf-8")
    if kind == "UInt8MultiArray":
        return bytes(message.data)
    raise PayloadError(f"'{type_name}' has no single value that could be sent as text")


def primitive_value(type_name: str, payload: bytes) -> Any:
    """Return what a text means for the field ``data`` of a type of ``std_msgs``.

    Raises
    ------
    PayloadError
        When it is none of its values.
    """
    kind = _short(type_name)
    if kind == "UInt8MultiArray":
        return list(payload)
    if kind != "String" and kind not in ("Bool", "Float32", "Float64", *_INTEGERS):
        raise PayloadError(f"'{type_name}' has no single value that could be sent as text")
    text = _text(payload)
    if kind == "String":
        return text
    if kind == "Bool" and text.lower() in ("true", "1", "false", "0"):
        return text.lower() in ("true", "1")
    if kind in _INTEGERS and _INTEGER.fullmatch(text):
        return int(text)
    if kind == "Float64" and _FLOAT.fullmatch(text):
        return float(text)
    if kind == "Float32" and _FLOAT.fullmatch(text):
        with np.errstate(over="ignore"):
            rounded = float(np.float32(text))
        return rounded if math.isfinite(rounded) else float(text)  # which is refused where it is too large
    raise PayloadError(f"{text[:40]!r} is no {kind}")


def primitive_type(payload: bytes) -> str:
    """Return the type that a text is taken for: Bool, Int32, Float32 or String."""
    text = _text(payload)
    if text.lower() in ("true", "false"):
        return "std_msgs/msg/Bool"
    if _INTEGER.fullmatch(text) and len(text) < 12 and -(2**31) <= int(text) < 2**31:
        return "std_msgs/msg/Int32"
    return "std_msgs/msg/Float32" if _FLOAT.fullmatch(text) else "std_msgs/msg/String"


def to_json(message: Any) -> bytes:
    """Return a message as JSON; numbers that JSON does not know (NaN, infinity) are null."""
    return json.dumps(_replaced(message_to_ordereddict(message), _null), separators=(",", ":")).encode()


def from_json(kind: Any, payload: bytes) -> Any:
    """Return the message of a JSON object; fields that it leaves out keep their defaults, null is NaN.

    Raises
    ------
    PayloadError
        When it is not valid JSON, or does not fit the type.
    """
    try:
        content = json.loads(_text(payload))
    except (ValueError, RecursionError) as error:
        raise PayloadError(f"is not valid JSON: {error}") from None
    if not isinstance(content, dict):
        raise PayloadError(f"is no JSON object, but {json.dumps(content)[:40]}")
    message = kind()
    return _filled(message, lambda: set_message_fields(message, _replaced(content, _nan)))


def primitive_message(kind: Any, type_name: str, payload: bytes) -> Any:
    """Return the message of a text; see `primitive_value`."""
    message, value = kind(), primitive_value(type_name, payload)
    return _filled(message, lambda: set_message_fields(message, {"data": value}))


def split_stamp(payload: bytes) -> tuple[Time, bytes]:
    """Return the time of sending and the message behind it.

    Raises
    ------
    PayloadError
        When the payload is too short.
    """
    return check_cdr(Time, payload[:STAMP_LENGTH]), payload[STAMP_LENGTH:]


def check_cdr(kind: Any, payload: bytes) -> Any:
    """Return the message of CDR bytes.

    Raises
    ------
    PayloadError
        When they are none of the type.
    """
    try:
        return deserialize_message(payload, kind)
    except CdrError as error:
        raise PayloadError(f"is no {kind.__name__} in CDR: {error}") from None


def _filled(message: Any, fill: Callable[[], object]) -> Any:
    try:
        fill()
        serialize_message(message)
    except (AttributeError, TypeError, ValueError, AssertionError, OverflowError) as error:
        raise PayloadError(f"does not fit {type(message).__name__}: {error}") from None
    return message


def _short(type_name: str) -> str:
    return type_name.rpartition("/")[2] if type_name.startswith("std_msgs/") else ""


def _text(payload: bytes) -> str:
    try:
        return payload.decode()
    except UnicodeDecodeError:
        raise PayloadError("is not valid UTF-8") from None


def _null(value: Any) -> Any:
    return None if isinstance(value, float) and not math.isfinite(value) else value


class _Null(float):
    """NaN that only a field of a number takes."""

    def __str__(self) -> str:
        raise TypeError("null is no text")


def _nan(value: Any) -> Any:
    return _Null(math.nan) if value is None else value


def _replaced(value: Any, replace: Callable[[Any], Any]) -> Any:
    """Return nested mappings and lists with each value replaced."""
    if isinstance(value, dict):
        return {name: _replaced(one, replace) for name, one in value.items()}
    if isinstance(value, list):
        return [_replaced(one, replace) for one in value]
    return replace(value)
