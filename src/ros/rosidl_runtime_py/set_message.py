"""Setting the fields of a message from dictionaries."""

from __future__ import annotations

import array
from collections.abc import Callable, Mapping
from typing import Any

from daidalos.interfaces.message import TYPECODES, Message


def set_message_fields(
    msg: Any, values: Mapping[str, Any], expand_header_auto: bool = False, expand_time_now: bool = False
) -> list[Callable[[Any], None]]:
    """Set fields from a nested dictionary, such as YAML gives.

    Parameters
    ----------
    msg
        The message to change.
    values
        Values by field name; lists may also stand for the fields of a message in their order.
    expand_header_auto
        Whether the value ``auto`` for a header means: stamp it when it is sent.
    expand_time_now
        Whether the value ``now`` for a time means: the time when it is sent.

    Returns
    -------
    list of functions
        Each sets one time to the stamp it is called with; empty unless something is to be expanded.

    Raises
    ------
    AttributeError
        When the message has no field of a name.
    TypeError, ValueError, AssertionError
        When a field cannot hold its value.
    """
    if not hasattr(values, "items"):
        raise TypeError(f"Value '{values}' is expected to be a dictionary but is a {type(values).__name__}")
    stampers: list[Callable[[Any], None]] = []
    for name, value in values.items():
        if not hasattr(type(msg), name) or name not in msg.get_fields_and_field_types():
            fault = f"'{type(msg).__name__}' object has no attribute '{name}'"
            raise AttributeError(fault, name=str(name), obj=msg)
        fields = (field for field in getattr(msg, "_FIELDS", ()) if field[0] == name)
        # What is not a generated message, but looks like one, has the field types of the values that it holds.
        spec = next(fields, None) or (name, type(getattr(msg, name)), "single", 0, None)
        _set(msg, spec, value, expand_header_auto, expand_time_now, stampers)
    return stampers


def _set(
    msg: Any, spec: Any, value: Any, header_auto: bool, time_now: bool, stampers: list[Callable[[Any], None]]
) -> None:
    name, base, kind, _, _ = spec
    if kind != "single":
        setattr(msg, name, _sequence(base, value, header_auto, time_now, stampers))
    elif isinstance(base, str):
        try:
            setattr(msg, name, _primitive(base, value))
        except (TypeError, ValueError) as error:
            holder = getattr(msg, "_TYPE_NAME", "") or type(msg).__name__
            raise type(error)(f"field '{name}' of {holder}: {error}") from None
    elif value is None:
        return
    elif isinstance(value, base) or not issubclass(base, Message):
        setattr(msg, name, value if isinstance(value, base) else base(value))
    else:
        field = getattr(msg, name)
        type_name = base._TYPE_NAME
        if header_auto and value == "auto" and type_name == "std_msgs/msg/Header":
            stampers.append(lambda stamp: setattr(field, "stamp", stamp))
        elif time_now and value == "now" and type_name == "builtin_interfaces/msg/Time":
            stampers.append(lambda stamp: setattr(msg, name, stamp))
        else:
            stampers += set_message_fields(field, value, header_auto, time_now)


def _sequence(base: Any, value: Any, header_auto: bool, time_now: bool, stampers: list[Callable[[Any], None]]) -> Any:
    if isinstance(base, str):
        if base in TYPECODES and isinstance(value, (array.array, bytes)):
            return value
        if isinstance(value, Mapping) and all(item is None for item in value.values()):
            value = list(value)  # YAML's ``{a, b}``, a set
        if isinstance(value, (str, Mapping)) or not hasattr(value, "__iter__"):
            raise TypeError(f"Value '{value}' is expected to be a list but is a {type(value).__name__}")
        return [_primitive(base, item) for item in value]
    items = []
    for item in value:
        if isinstance(item, Message):
            items.append(item)
            continue
        one = base()
        stampers += set_message_fields(one, item, header_auto, time_now)
        items.append(one)
    return items


def _primitive(base: str, value: Any) -> Any:
    """Return a value as the type of its field: what YAML reads as a number may be meant as text, and so on."""
    if base in ("float32", "float64"):
        return float(value)
    if base in ("string", "wstring"):
        return value if isinstance(value, str) else str(value)
    if base == "bool":
        return value if isinstance(value, bool) else bool(value)
    if base == "byte":
        return value if isinstance(value, bytes) else bytes([int(value)])
    return value if isinstance(value, int) else int(value)
