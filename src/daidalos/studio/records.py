"""Frozen dataclasses as JSON objects: a field ``channel_ids`` here is the key ``channelIds`` there."""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping
from dataclasses import MISSING, dataclass, fields, is_dataclass
from functools import cache
from types import NoneType
from typing import Annotated, Any, TypeGuard, TypeVar, cast, get_args, get_origin, get_type_hints

T = TypeVar("T")

Uint32 = Annotated[int, "uint32"]

_KINDS: Mapping[object, tuple[type, str, str]] = {  # a field's type: Python's class, one of it, several of it
    str: (str, "a string", "strings"),
    int: (int, "a number", "numbers"),
    Uint32: (int, "a number of 32 bits", "numbers of 32 bits"),
}


class RecordError(ValueError):
    """A JSON value that is not the record that was expected; the text names the key and what it must be."""


def key_of(name: str) -> str:
    """Return the JSON key of a field."""
    first, *others = name.split("_")
    return first + "".join(part.capitalize() for part in others)


def to_json(value: Any) -> Any:
    """Return a record, and the records within it, as what `json.dumps` writes; fields that are None are left out."""
    if is_dataclass(value):
        found = ((field.name, getattr(value, field.name)) for field in fields(value))
        return {key_of(name): to_json(inner) for name, inner in found if inner is not None}
    if isinstance(value, Mapping):
        return {key: to_json(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [to_json(inner) for inner in value]
    return value


def from_json(record: type[T], value: Mapping[str, Any]) -> T:
    """Read a record from a JSON object; keys that it does not have are ignored.

    Raises
    ------
    RecordError
        When a required key is missing, or a value has another type.
    """
    return complete(from_json_in_steps(record, value))


def complete(steps: Generator[None, None, T]) -> T:
    """Do all steps and return their result."""
    while True:
        try:
            next(steps)
        except StopIteration as end:
            return cast(T, end.value)


def from_json_in_steps(record: type[T], value: Mapping[str, Any]) -> Generator[None, None, T]:
    """Read a record as `from_json` does, and yield after each record of its lists."""
    arguments = {}
    for name, key, read, expected, is_needed in _layout(record):  # type: ignore[arg-type]
        found = value.get(key)
        if found is not None:
            try:
                arguments[name] = (yield from read(found)) if isinstance(read, _RecordList) else read(found)
            except _UnfitError:
                raise _wrong(key, expected) from None
        elif is_needed:
            raise _wrong(key, expected)
    return record(**arguments)


class _UnfitError(Exception):
    """A value that is not of its field's type."""


def _wrong(key: str, expected: str) -> RecordError:
    return RecordError(f'expected "{key}" to be {expected}')


@cache
def _layout(record: type) -> list[tuple[str, str, Callable[[Any], Any], str, bool]]:
    """Return the name and key of a record's fields, what reads what describes them, whether they are required."""
    hints = field_types(record)
    return [
        (one.name, key_of(one.name), _reader(hints[one.name]), _expected(hints[one.name]), one.default is MISSING)
        for one in fields(record)
    ]


@cache
def field_types(record: type) -> dict[str, Any]:
    """Return the types of a record's fields by name, without the None of those that may be left out."""
    hints = get_type_hints(record, include_extras=True)
    return {field.name: _without_none(hints[field.name]) for field in fields(record)}


def _without_none(hint: Any) -> Any:
    members = get_args(hint)
    if NoneType not in members:
        return hint
    one, *others = (member for member in members if member is not NoneType)
    for other in others:
        one = one | other
    return one


def _reader(hint: Any) -> Callable[[Any], Any]:
    """Return a function that reads the value of a field's type; it raises `_UnfitError`."""
    if get_origin(hint) is tuple:
        element = get_args(hint)[0]
        return _RecordList(element) if is_record(element) else _list_reader(element)
    if hint not in _KINDS and not is_record(hint):
        return lambda value: value
    fits = _check(hint)

    def read(value: Any) -> Any:
        if not fits(value):
            raise _UnfitError
        return from_json(hint, value) if is_record(hint) else value

    return read


def _list_reader(element: Any) -> Callable[[Any], tuple[Any, ...]]:
    fits = _check(element)

    def read(value: Any) -> tuple[Any, ...]:
        if not isinstance(value, list) or not all(map(fits, value)):
            raise _UnfitError
        return tuple(value)

    return read


@dataclass(frozen=True)
class _RecordList:
    """Function that reads a list of records, one a step."""

    element: type[Any]

    def __call__(self, value: Any) -> Generator[None, None, tuple[Any, ...]]:
        if not isinstance(value, list) or not all(isinstance(item, dict) for item in value):
            raise _UnfitError
        records = []
        for item in value:
            records.append((yield from from_json_in_steps(self.element, item)))
            yield
        return tuple(records)


def _check(hint: Any) -> Callable[[Any], bool]:
    """Return a function that returns whether a value is of a type."""
    if hint == Uint32:
        return lambda value: isinstance(value, int) and 0 <= value < 1 << 32
    if not is_record(hint) and hint not in _KINDS:
        return lambda value: True
    kind = dict if is_record(hint) else _KINDS[hint][0]
    return lambda value: isinstance(value, kind)


def is_record(hint: Any) -> TypeGuard[type[Any]]:
    """Return whether a field's type is a record."""
    return isinstance(hint, type) and is_dataclass(hint)


def _expected(hint: Any) -> str:
    if get_origin(hint) is tuple:
        element = get_args(hint)[0]
        return f"a list of {_KINDS[element][2] if element in _KINDS else 'objects'}"
    return _KINDS[hint][1] if hint in _KINDS else "an object"
