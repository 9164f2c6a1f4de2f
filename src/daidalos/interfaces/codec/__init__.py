"""CDR codecs, compiled from the fields of a message class on first use.

The wire format is XCDR1 (OMG DDS-XTypes 1.3, 7.4.1): little-endian, alignment relative to the byte after the
four-byte encapsulation header. Runs of fixed-size values become one `struct` call; where the run starts at an
offset that is known only at run time, the call is chosen by that offset modulo 8 from a table of eight.
"""

from __future__ import annotations

import struct
from array import array
from collections.abc import Callable
from typing import Any

from daidalos.interfaces.codec._decoder import Decoder
from daidalos.interfaces.codec._encoder import Encoder
from daidalos.interfaces.codec._snapshot import Snapshot
from daidalos.interfaces.codec._text import Variant
from daidalos.interfaces.message import Message

LITTLE_ENDIAN = b"\x00\x01"
BIG_ENDIAN = b"\x00\x00"


class CdrError(ValueError):
    """Bytes that are not a valid serialized message of the type, or a message that cannot be serialized."""


class FieldError(CdrError, TypeError):
    """A message that cannot be serialized or copied because a field holds a value its type does not allow."""


class Codec:
    """Serializer and deserializer of one message class.

    Attributes
    ----------
    encode
        ``encode(message) -> bytes``: CDR with its encapsulation header.
    parts
        ``parts(message) -> list of buffers`` whose concatenation is what `encode` returns. The buffers may
        share memory with the message.
    decode
        ``decode(data: bytes) -> message``.
    snapshot
        ``snapshot(message) -> message``: a deep copy.

    `decode` raises `CdrError`, the others `FieldError`.
    """

    __slots__ = ("_wide", "decode", "encode", "message_type", "parts", "snapshot")

    def __init__(self, message_type: type[Message], wide: int = 4) -> None:
        self.message_type = message_type
        self._wide = wide
        self.encode: Callable[[Any], bytes] = self._first_encode
        self.parts: Callable[[Any], list[Any]] = self._first_parts
        self.decode: Callable[[bytes], Any] = self._first_decode
        self.snapshot: Callable[[Any], Any] = self._first_snapshot

    # Each function replaces itself by its compiled form at the first call: who only publishes
    # never pays for a decoder.

    def _first_encode(self, message: Any) -> bytes:
        self._compile_encoder()
        return self.encode(message)

    def _first_parts(self, message: Any) -> list[Any]:
        self._compile_encoder()
        return self.parts(message)

    def _compile_encoder(self) -> None:
        parts = _compile("parts", Encoder(self.message_type, Variant(wide=self._wide)).source())
        kind = self.message_type

        def encode(message: Any, join: Callable[[list[Any]], bytes] = b"".join) -> bytes:
            if message.__class__ is not kind:
                _check_kind(message, kind)
            try:
                return join(parts(message))
            except (struct.error, TypeError, AttributeError, ValueError, OverflowError) as error:
                raise self._unfit(message, error) from None

        def checked_parts(message: Any) -> list[Any]:
            if message.__class__ is not kind:
                _check_kind(message, kind)
            try:
                buffers: list[Any] = parts(message)
                return buffers
            except (struct.error, TypeError, AttributeError, ValueError, OverflowError) as error:
                raise self._unfit(message, error) from None

        self.encode, self.parts = encode, checked_parts

    def _first_decode(self, data: bytes) -> Any:
        self.decode = self._compile_decoder()
        return self.decode(data)

    def _compile_decoder(self) -> Callable[[bytes], Any]:
        kind = self.message_type
        little = _compile("decode", Decoder(kind, Variant(wide=self._wide)).source())
        other_width = _has_wide_strings(kind)

        def decode(data: Any) -> Any:
            if data.__class__ is not bytes:
                data = bytes(data)
            if data[:2] != LITTLE_ENDIAN:
                return self._decode_other(data)
            try:
                return little(data)
            except (struct.error, IndexError, ValueError, OverflowError) as error:
                if other_width:
                    return self._decode_other_width(data)
                raise CdrError(_truncated(kind, data, error)) from None

        return decode

    def _decode_other(self, data: bytes) -> Any:
        """Decode big-endian data; compiled on first arrival since it is rare."""
        if data[:2] != BIG_ENDIAN or len(data) < 4:
            start = data[:4].hex(" ") or "nothing"
            raise CdrError(
                f"invalid CDR data of {self.message_type._TYPE_NAME}: it starts with {start}, "
                "expected 00 01 (little-endian CDR) or 00 00 (big-endian CDR)"
            )
        decode = _compile("decode", Decoder(self.message_type, Variant(">", self._wide)).source())
        try:
            return decode(data)
        except (struct.error, IndexError, ValueError, OverflowError) as error:
            raise CdrError(_truncated(self.message_type, data, error)) from None

    def _decode_other_width(self, data: bytes) -> Any:
        """Decode wide strings in the width of the other middlewares (2 or 4 bytes per character)."""
        decode = _compile("decode", Decoder(self.message_type, Variant(wide=6 - self._wide)).source())
        try:
            return decode(data)
        except (struct.error, IndexError, ValueError, OverflowError) as error:
            raise CdrError(_truncated(self.message_type, data, error)) from None

    def _unfit(self, message: Any, error: Exception) -> FieldError:
        """Return an error that names the field whose value its type does not allow."""
        return FieldError(_explain(message, error))

    def _first_snapshot(self, message: Any) -> Any:
        self.snapshot = _compile("snapshot", Snapshot(self.message_type, self._unfit).source())
        return self.snapshot(message)


_CODECS: dict[tuple[type[Message], int], Codec] = {}


def codec_of(message_type: type[Message], wide: int = 4) -> Codec:
    """Return the codec of a message class.

    Parameters
    ----------
    message_type
        A generated message class.
    wide
        Bytes a character of a ``wstring`` takes: 4 as Cyclone DDS writes it, 2 as Fast-CDR (and zenoh) does.
    """
    key = (message_type, wide)
    codec = _CODECS.get(key)
    if codec is None:
        plain = (message_type, 4)
        if wide == 4 or _has_wide_strings(message_type):
            codec = Codec(message_type, wide)
        else:
            codec = _CODECS.setdefault(plain, Codec(message_type))
        codec = _CODECS.setdefault(key, codec)
    return codec


def _compile(name: str, source: tuple[str, dict[str, Any]]) -> Callable[..., Any]:
    text, names = source
    scope: dict[str, Any] = {"array": array, "new": object.__new__, **names}
    exec(compile(text, f"<{name} of {names['Root']._TYPE_NAME}>", "exec"), scope)
    function: Callable[..., Any] = scope[name]
    return function


def _has_wide_strings(kind: type[Message]) -> bool:
    return any(base == "wstring" if isinstance(base, str) else _has_wide_strings(base) for _, base, *_ in kind._FIELDS)


def _check_kind(message: object, kind: type[Message]) -> None:
    if not isinstance(message, kind):
        raise TypeError(f"expected a message of type '{kind._TYPE_NAME}', not '{type(message).__name__}'")


def _truncated(kind: type[Message], data: bytes, error: Exception) -> str:
    return f"{len(data)} bytes are not a valid {kind._TYPE_NAME}: {error}"


def _explain(message: Any, error: Exception) -> str:
    """Return a description of the field that cannot be serialized."""
    for name, base, kind, _, _ in message._FIELDS:
        value = getattr(message, name, None)
        try:
            setattr(message, name, value)
        except AssertionError as reason:
            return f"cannot serialize {message._TYPE_NAME}: {reason}"
        if not isinstance(base, str):
            for item in [value] if kind == "single" else value or []:
                if not isinstance(item, base):
                    return (
                        f"cannot serialize {message._TYPE_NAME}: The '{name}' field holds a "
                        f"'{type(item).__module__}.{type(item).__name__}', which only stands for a {base._TYPE_NAME}"
                    )
                inner = _explain(item, error)
                if ": The " in inner:
                    return inner
    return f"cannot serialize {message._TYPE_NAME}: {error}"
