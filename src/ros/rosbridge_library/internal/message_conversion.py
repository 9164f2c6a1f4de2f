"""Messages as values for JSON, and back: arrays of bytes are texts in base64, NaN and infinities null."""

from __future__ import annotations

import array
import math
import re
from base64 import standard_b64decode, standard_b64encode
from typing import Any

import numpy as np
from rclpy.clock import ROSClock

from rosbridge_library.internal import ros_loader

_FLOATS = ["float", "double", "float32", "float64"]
_INTEGERS = ["int8", "octet", "uint8", "char", "int16", "uint16", "int32", "uint32", "int64", "uint64"]
type_map = {
    "bool": ["bool", "boolean"],
    "int": _INTEGERS,
    "float": _FLOATS,
    "str": ["string", "wstring"],
    "bytes": ["octet"],
}
"""Types of fields by type of Python."""
primitive_types = [bool, int, float]
list_types: list[Any] = [list, tuple, np.ndarray, array.array]
ros_time_types = ["builtin_interfaces/Time", "builtin_interfaces/Duration"]
ros_primitive_types = ["bool", "boolean", *_INTEGERS, *_FLOATS, "byte", "string", "wstring"]
ros_header_types = ["std_msgs/Header", "roslib/Header"]
ros_binary_types = ["uint8[]", "char[]", "sequence<uint8>", "sequence<char>"]

_BYTES = re.compile(r"(uint8|char)\[[^\]]*\]|sequence<(uint8|char)(, *\d+)?>")
_SEQUENCE = re.compile(r"sequence<(?P<one>[^,]+?(?:<\d+>)?)(?:, *\d+)?>")
_ARRAY = re.compile(r"(?P<one>.+)\[.*\]")


class InvalidMessageException(Exception):
    """Error of what is not a message."""

    def __init__(self, inst: Any) -> None:
        super().__init__(f"Unable to extract message values from {type(inst).__name__} instance")


class NonexistentFieldException(Exception):
    """Error of a field that a message does not have."""

    def __init__(self, basetype: str, fields: list[str]) -> None:
        super().__init__(f"Message type {basetype} does not have a field {'.'.join(fields)}")


class FieldTypeMismatchException(Exception):
    """Error of a value that does not fit a field."""

    def __init__(self, roottype: str, fields: list[str], expected_type: str, found_type: Any) -> None:
        if roottype == expected_type:
            super().__init__(f"Expected a JSON object for type {roottype} but received a {found_type}")
        else:
            path = ".".join(fields)
            super().__init__(f"{roottype} message requires a {expected_type} for field {path}, but got a {found_type}")


def extract_values(inst: Any) -> dict[str, Any]:
    """Return the fields of a message as values for JSON; raises InvalidMessageException for what is not one."""
    if not hasattr(inst, "get_fields_and_field_types"):
        raise InvalidMessageException(inst)
    values: dict[str, Any] = _from_inst(inst, msg_instance_type_repr(inst))
    return values


def populate_instance(msg: dict[str, Any], inst: Any, clock: Any = None) -> Any:
    """Set fields of a message from values of JSON, and return the message.

    Parameters
    ----------
    msg
        Values by field; a time may be ``"now"``.
    inst
        The message.
    clock
        Clock for ``"now"`` and for the stamps of headers; one of ROS time where None.

    Raises
    ------
    NonexistentFieldException, FieldTypeMismatchException
        For a field that does not exist, and a value that does not fit.
    """
    kind = msg_instance_type_repr(inst)
    return _to_inst(msg, kind, kind, clock, inst)


def msg_instance_type_repr(msg_inst: Any) -> str:
    """Return the name of a message's type, such as ``std_msgs/String``."""
    return msg_class_type_repr(type(msg_inst), short=True)


def msg_class_type_repr(msg_class: type, short: bool = False) -> str:
    """Return the name of a class, such as ``std_msgs/msg/String``, without the kind where `short`."""
    package, *rest = msg_class.__module__.split(".")
    if not rest:
        return str(msg_class)
    return f"{package}/{msg_class.__name__}" if short else f"{package}/{rest[0]}/{msg_class.__name__}"


def _is_binary(rostype: str) -> bool:
    return _BYTES.fullmatch(rostype) is not None


def _is_list(value: Any) -> bool:
    return isinstance(value, tuple(list_types))


def _element(rostype: str) -> str:
    """Return the type of the items of a list."""
    match = _SEQUENCE.fullmatch(rostype) or _ARRAY.fullmatch(rostype)
    if match is None:
        raise ValueError(f"'{rostype}' is not a list")
    return match["one"]


def _base(rostype: str) -> str:
    """Return a type without the bound of strings."""
    return re.sub(r"^(w?string)<\d+>$", r"\1", rostype)


def _from_inst(inst: Any, rostype: str) -> Any:
    rostype = _base(rostype)
    if _is_binary(rostype):
        return standard_b64encode(bytes(bytearray(inst))).decode("ascii")
    if rostype in ros_time_types:
        return {"sec": inst.sec, "nanosec": inst.nanosec}
    if rostype in ros_primitive_types:
        if rostype in _FLOATS and not math.isfinite(inst):
            return None
        return int.from_bytes(inst, "little") if isinstance(inst, bytes) else inst
    if _is_list(inst):
        one = _element(rostype)
        plain = inst.tolist() if isinstance(inst, np.ndarray | array.array) else inst
        return [_from_inst(item, one) for item in plain]
    return {name: _from_inst(getattr(inst, name), kind) for name, kind in inst.get_fields_and_field_types().items()}


def _to_inst(
    msg: Any, rostype: str, roottype: str, clock: Any = None, inst: Any = None, stack: list[str] | None = None
) -> Any:
    stack = stack or []
    rostype = _base(rostype)
    if _is_binary(rostype):
        return _to_binary_inst(msg)
    if rostype in ros_time_types:
        return _to_time_inst(msg, rostype, clock, inst)
    if rostype in ros_primitive_types:
        return _to_primitive_inst(msg, rostype, roottype, stack)
    if _SEQUENCE.fullmatch(rostype) or _ARRAY.fullmatch(rostype):
        return _to_list_inst(msg, rostype, roottype, clock, inst, stack)
    if inst is None:
        inst = ros_loader.get_message_instance(rostype)
    return _to_object_inst(msg, rostype, roottype, clock, inst, stack)


def _to_binary_inst(msg: Any) -> Any:
    if isinstance(msg, str):
        return list(standard_b64decode(msg))
    return msg if isinstance(msg, list) else array.array("B", bytes(msg))


def _to_time_inst(msg: Any, rostype: str, clock: Any, inst: Any) -> Any:
    if rostype == "builtin_interfaces/Time" and msg == "now":
        return (clock or ROSClock()).now().to_msg()
    if inst is None:
        inst = ros_loader.get_message_instance(rostype)
    if not isinstance(msg, dict):
        raise FieldTypeMismatchException(rostype, [], rostype, type(msg))
    for field, names in (("sec", ("sec", "secs")), ("nanosec", ("nanosec", "nsecs"))):
        for name in names:
            if name in msg:
                setattr(inst, field, msg[name])
                break
    return inst


def _to_primitive_inst(msg: Any, rostype: str, roottype: str, stack: list[str]) -> Any:
    if rostype in _FLOATS and isinstance(msg, int) and not isinstance(msg, bool):
        msg = float(msg)
    if rostype == "octet" and isinstance(msg, int):
        return bytes([msg])
    if rostype in type_map.get(type(msg).__name__, ()):
        return msg
    raise FieldTypeMismatchException(roottype, stack, rostype, type(msg))


def _to_list_inst(msg: Any, rostype: str, roottype: str, clock: Any, inst: Any, stack: list[str]) -> Any:
    if not _is_list(msg):
        raise FieldTypeMismatchException(roottype, stack, rostype, type(msg))
    if isinstance(inst, np.ndarray):
        inst[:] = msg
        return inst
    if isinstance(inst, array.array):
        return array.array(inst.typecode, [float(one) for one in msg] if inst.typecode in "fd" else msg)
    one = _element(rostype)
    return [_to_inst(item, one, roottype, clock, None, stack) for item in msg]


def _to_object_inst(msg: Any, rostype: str, roottype: str, clock: Any, inst: Any, stack: list[str]) -> Any:
    if not isinstance(msg, dict):
        raise FieldTypeMismatchException(roottype, stack, rostype, type(msg))
    if rostype in ros_header_types:
        inst.stamp = (clock or ROSClock()).now().to_msg()
    fields = inst.get_fields_and_field_types()
    for name, value in msg.items():
        path = [*stack, name]
        if name not in fields:
            raise NonexistentFieldException(roottype, path)
        setattr(inst, name, _to_inst(value, fields[name], roottype, clock, getattr(inst, name), path))
    return inst
