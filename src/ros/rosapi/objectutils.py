"""Fields and constants of messages, as clients ask for them."""

from __future__ import annotations

import logging
import re
from typing import Any

from rosbridge_library.internal import ros_loader
from rosbridge_library.internal.message_conversion import msg_instance_type_repr
from rosidl_runtime_py.get_interfaces import interface_library

from rosapi.stringify_field_types import stringify_field_types

_LOGGER = logging.getLogger(__name__)

atomics = [
    "bool", "boolean", "byte", "char", "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64",
    "float", "float32", "float64", "double", "string", "wstring", "octet",
]  # fmt: skip
"""Types without fields."""
_SEQUENCE = re.compile(r"sequence<([^,]+?(?:<\d+>)?)(?:, *\d+)?>")
_ARRAY = re.compile(r"(.+)\[(\d*)\]")
_BOUND = re.compile(r"(w?string)<\d+>")

TypeDef = dict[str, Any]
"""Fields ``type``, ``fieldnames``, ``fieldtypes``, ``fieldarraylen`` (-1 for one value, 0 for any number),
``examples``, ``constnames`` and ``constvalues``."""


def get_typedef(type: str) -> TypeDef | None:
    """Return the fields of a message, or of the items of a sequence; None where it has none or is not known."""
    kind = _split(type)[0]
    if kind in atomics:
        return None
    try:
        return _typedef(ros_loader.get_message_instance(kind))
    except (
        ros_loader.InvalidTypeStringException,
        ros_loader.InvalidModuleException,
        ros_loader.InvalidClassException,
    ) as error:
        _LOGGER.error("no definition of %s: %s", type, error)
        return None


def get_service_request_typedef(servicetype: str) -> TypeDef:
    """Return the fields of a service's request."""
    return _typedef(ros_loader.get_service_request_instance(servicetype))


def get_service_response_typedef(servicetype: str) -> TypeDef:
    """Return the fields of a service's response."""
    return _typedef(ros_loader.get_service_response_instance(servicetype))


def get_typedef_recursive(type: str) -> list[TypeDef]:
    """Return the fields of a message and of the messages in it, each once."""
    root = get_typedef(type)
    return [] if root is None else _with_parts(root)


def get_service_request_typedef_recursive(servicetype: str) -> list[TypeDef]:
    """Return the fields of a service's request and of the messages in it."""
    return _with_parts(get_service_request_typedef(servicetype))


def get_service_response_typedef_recursive(servicetype: str) -> list[TypeDef]:
    """Return the fields of a service's response and of the messages in it."""
    return _with_parts(get_service_response_typedef(servicetype))


def get_typedef_full_text(ty: str) -> str:
    """Return the definition of a message with those of its fields; a comment with the reason where there is none."""
    try:
        return stringify_field_types(ty)
    except Exception as error:  # of one type among many that a client asks for
        return f"# failed to get full definition text for {ty}: {error}"


def _with_parts(root: TypeDef) -> list[TypeDef]:
    found = [root]
    seen = {root["type"]}
    for one in found:
        for kind in one["fieldtypes"]:
            if kind not in seen and kind not in atomics:
                seen.add(kind)
                part = get_typedef(kind)
                if part is not None:
                    found.append(part)
    return found


def _typedef(instance: Any) -> TypeDef:
    fields = instance.get_fields_and_field_types()
    kinds = [_split(kind) for kind in fields.values()]
    constants = _constants(instance)
    return {
        "type": msg_instance_type_repr(instance),
        "fieldnames": list(fields),
        "fieldtypes": [kind for kind, _ in kinds],
        "fieldarraylen": [length for _, length in kinds],
        "examples": [
            "[]" if length >= 0 else str(getattr(instance, name)) if kind in atomics else "{}"
            for name, (kind, length) in zip(fields, kinds, strict=True)
        ],
        "constnames": list(constants),
        "constvalues": [str(value) for value in constants.values()],
    }


def _split(kind: str) -> tuple[str, int]:
    """Return the type of one item and the number of items: -1 for a single one, 0 for any number."""
    if (many := _SEQUENCE.fullmatch(kind)) is not None:
        name, length = many[1], 0
    elif (many := _ARRAY.fullmatch(kind)) is not None:
        name, length = many[1], int(many[2] or 0)
    else:
        name, length = kind, -1
    return _BOUND.sub(r"\1", name), length


def _constants(instance: Any) -> dict[str, Any]:
    package, kind = type(instance).__module__.split(".")[:2]
    definition = interface_library().get(f"{package}/{kind}/{type(instance).__name__}")
    return {constant.name: constant.value for constant in getattr(definition, "constants", ())}
