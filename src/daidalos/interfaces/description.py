"""Type descriptions and their hashes (REP 2016, `RIHS01`)."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from daidalos.interfaces.definition import Action, Field, FieldType, Interface, Kind, Message, Service

Lookup = Callable[[str], Interface]
"""Finds the definition behind a full name such as ``geometry_msgs/msg/Point``."""

_TYPE_IDS = {
    "int8": 2, "uint8": 3, "char": 3, "int16": 4, "uint16": 5, "int32": 6, "uint32": 7, "int64": 8,
    "uint64": 9, "float32": 10, "float64": 11, "bool": 15, "byte": 16, "string": 17, "wstring": 18,
}  # fmt: skip
_NESTED = 1
_BOUNDED_STRINGS = {"string": 21, "wstring": 22}
_KIND_OFFSET = {Kind.SINGLE: 0, Kind.ARRAY: 48, Kind.BOUNDED: 96, Kind.UNBOUNDED: 144}


@dataclass(frozen=True)
class FieldDescription:
    """Field as in ``type_description_interfaces/msg/Field``."""

    name: str
    type_id: int
    capacity: int
    string_capacity: int
    nested_type_name: str
    default_value: str = ""


@dataclass(frozen=True)
class IndividualDescription:
    """Type as in ``type_description_interfaces/msg/IndividualTypeDescription``."""

    type_name: str
    fields: tuple[FieldDescription, ...]


@dataclass(frozen=True)
class Description:
    """Type with every type that it refers to, sorted by name."""

    type_description: IndividualDescription
    referenced: tuple[IndividualDescription, ...]

    def type_hash(self) -> str:
        """Return the ``RIHS01_...`` hash of the description."""
        text = json.dumps(
            {
                "type_description": _hashed(self.type_description),
                "referenced_type_descriptions": [_hashed(other) for other in self.referenced],
            },
            ensure_ascii=True,
        )
        return "RIHS01_" + hashlib.sha256(text.encode()).hexdigest()


def describe(interface: Interface, lookup: Lookup) -> Description:
    """Return the description of an interface with all types that it refers to.

    Raises
    ------
    LookupError
        When a referenced type has no definition.
    """
    local: dict[str, Interface] = {}
    for part in _parts(interface):
        local[part.name] = part
    found: dict[str, IndividualDescription] = {}
    pending = list(_references(interface))
    while pending:
        name = pending.pop()
        if name not in found:
            other = local.get(name) or lookup(name)
            found[name] = _individual(other)
            pending.extend(_references(other))
    found.pop(interface.name, None)
    return Description(_individual(interface), tuple(found[name] for name in sorted(found)))


def _parts(interface: Interface) -> Iterator[Interface]:
    if isinstance(interface, Service):
        yield from interface.messages
    elif isinstance(interface, Action):
        yield from interface.messages
        yield interface.send_goal
        yield interface.get_result


def _members(interface: Interface) -> tuple[Field, ...]:
    """Return the fields of a message, or the parts of a service or action as fields."""
    if isinstance(interface, Message):
        return interface.fields or (Field(FieldType("uint8"), "structure_needs_at_least_one_member"),)
    if isinstance(interface, Service):
        names = ("request_message", "response_message", "event_message")
        return tuple(Field(FieldType(m.name), n) for n, m in zip(names, interface.messages, strict=True))
    parts: dict[str, Message | Service] = {
        "goal": interface.goal,
        "result": interface.result,
        "feedback": interface.feedback,
        "send_goal_service": interface.send_goal,
        "get_result_service": interface.get_result,
        "feedback_message": interface.feedback_message,
    }
    return tuple(Field(FieldType(part.name), name) for name, part in parts.items())


def _references(interface: Interface) -> Iterator[str]:
    for field in _members(interface):
        if not field.type.is_primitive:
            yield field.type.base


def _individual(interface: Interface) -> IndividualDescription:
    return IndividualDescription(interface.name, tuple(_field(field) for field in _members(interface)))


def _field(field: Field) -> FieldDescription:
    kind = field.type
    if not kind.is_primitive:
        type_id = _NESTED
    elif kind.string_bound is not None:
        type_id = _BOUNDED_STRINGS[kind.base]
    else:
        type_id = _TYPE_IDS[kind.base]
    default = "" if field.default is None else json.dumps(field.default)
    return FieldDescription(
        name=field.name,
        type_id=type_id + _KIND_OFFSET[kind.kind],
        capacity=kind.size,
        string_capacity=kind.string_bound or 0,
        nested_type_name="" if kind.is_primitive else kind.base,
        default_value=default,
    )


def _hashed(description: IndividualDescription) -> dict[str, object]:
    return {
        "type_name": description.type_name,
        "fields": [
            {
                "name": field.name,
                "type": {
                    "type_id": field.type_id,
                    "capacity": field.capacity,
                    "string_capacity": field.string_capacity,
                    "nested_type_name": field.nested_type_name,
                },
            }
            for field in description.fields
        ],
    }
