"""Conversion between dataclasses and messages by equal field names."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import fields, is_dataclass
from functools import cache, cached_property
from importlib import import_module
from operator import attrgetter
from typing import Any

import numpy as np

from daidalos.samples.fields import floats, header, nanoseconds

Source = str | Callable[[Any], Any]
"""Name of the dataclass's field, or a function of the dataclass that returns the value of the message's field."""


class Conversion:
    """Conversion of a dataclass to and from messages.

    Fields of equal name hold the same value. An array (n,) becomes a nested message of n numbers, such as a
    ``Vector3``, and a dataclass becomes a nested message by equal names. ``stamp_ns`` and ``frame_id`` are the header,
    which nested messages share. Other fields of the message keep their defaults.

    Parameters
    ----------
    kind : type
        The dataclass.
    message : str
        Name of the message type, such as ``sensor_msgs/Imu``.
    sources : mapping, optional
        Where field names differ: from the message's field, such as ``twist.linear``, to its `Source`.
    to_message, from_message : callable, optional
        Convert in place of the field names; `from_message` takes a message.
    """

    def __init__(
        self,
        kind: type,
        message: str,
        sources: Mapping[str, Source] | None = None,
        *,
        to_message: Callable[[Any], Any] | None = None,
        from_message: Callable[[Any], Any] | None = None,
    ) -> None:
        self.kind = kind
        self.message = message
        self.sources = sources or {}
        if to_message is not None:
            self.to_message = to_message
        if from_message is not None:
            self.from_message = from_message

    @cached_property
    def message_class(self) -> Any:
        """Message class, imported at the first use."""
        package, _, name = self.message.partition("/")
        return getattr(import_module(f"{package}.msg"), name)

    @cached_property
    def to_message(self) -> Callable[[Any], Any]:
        """Function that returns an object of the dataclass as a message."""
        return _writer(self.message_class, self.sources, _names(self.kind))

    @cached_property
    def from_message(self) -> Callable[[Any], Any]:
        """Function that returns a message as an object of the dataclass."""
        return _reader(self.kind, self.message_class, self.sources)


def _names(kind: type) -> frozenset[str]:
    return frozenset(field.name for field in fields(kind))


def _writer(message: Any, sources: Mapping[str, Source], names: frozenset[str]) -> Callable[[Any], Any]:
    """Return the function that makes a message of a class from an object with fields of these names."""
    direct = {path: source for path, source in sources.items() if "." not in path}
    nested: dict[str, dict[str, Source]] = {}
    for path, source in sources.items():
        first, _, rest = path.partition(".")
        if rest:
            nested.setdefault(first, {})[rest] = source
    known = [name for name, *_ in message._FIELDS]
    unknown = [name for name in (*direct, *nested) if name not in known]
    if unknown:
        raise TypeError(f"{message.__name__} has no field '{unknown[0]}'")
    parts: list[tuple[str, Callable[[Any], Any]]] = []
    for name, kind, arity, *_ in message._FIELDS:
        if name in nested:
            parts.append((name, _writer(kind, nested[name], frozenset())))
        elif name in direct or name in names:
            parts.append((name, _part(direct.get(name, name), kind, arity == "single")))
        elif name == "header":
            parts.append((name, header))

    def write(sample: Any) -> Any:
        return message(**{name: part(sample) for name, part in parts})

    return write


def _part(source: Source, kind: Any, single: bool) -> Callable[[Any], Any]:
    """Return the function that makes the value of one field of a message."""
    get = attrgetter(source) if isinstance(source, str) else source
    if isinstance(kind, str):
        if single:
            return get
        convert = floats if kind == "float32" else list if kind == "string" else _flat
        return lambda sample: convert(get(sample))
    if single:
        return lambda sample: nested_message(kind, get(sample))
    return lambda sample: [nested_message(kind, value) for value in get(sample)]


def _flat(values: Any) -> Any:
    return values.ravel() if isinstance(values, np.ndarray) else list(values)


def nested_message(message: Any, value: Any) -> Any:
    """Return a value as a message of a class.

    Parameters
    ----------
    message : type
        The message class.
    value : object
        A message of the class, a dataclass with fields of equal names, or numbers in the order of the fields.
    """
    kind: Any = type(value)
    return _nested(message, kind)(value)


@cache
def _nested(message: Any, kind: type) -> Callable[[Any], Any]:
    """Return the function that makes a message of a class from a value of another class."""
    if issubclass(kind, message):
        return lambda value: value
    if is_dataclass(kind):
        return _writer(message, {}, _names(kind))
    names = tuple(message._fields_and_field_types)
    if issubclass(kind, np.ndarray):
        return lambda value: message(**dict(zip(names, value.tolist(), strict=True)))
    return lambda value: message(**dict(zip(names, value, strict=True)))


def _reader(kind: type, message: Any, sources: Mapping[str, Source]) -> Callable[[Any], Any]:
    """Return the function that makes an object of a dataclass from a message of a class."""
    paths = {source: path for path, source in sources.items() if isinstance(source, str)}
    parts = [(field.name, _value(message, paths.get(field.name, field.name))) for field in fields(kind)]
    return lambda received: kind(**{name: part(received) for name, part in parts})


def _value(message: Any, path: str) -> Callable[[Any], Any]:
    """Return the function that reads one value from a message."""
    if path == "stamp_ns":
        return lambda received: nanoseconds(received.header.stamp)
    if path == "frame_id":
        return attrgetter("header.frame_id")
    kind, single = message, True
    for name in path.split("."):
        kind, single = next((kind, arity == "single") for own, kind, arity, *_ in kind._FIELDS if own == name)
    get = attrgetter(path)
    if not isinstance(kind, str):
        names = [name for name, *_ in kind._FIELDS]
        return lambda received: _numbers(getattr(get(received), name) for name in names)
    if single:
        return get
    return (lambda received: tuple(get(received))) if kind == "string" else (lambda received: _numbers(get(received)))


def _numbers(values: Iterable[float]) -> Any:
    return np.array(list(values), dtype=np.float64)
