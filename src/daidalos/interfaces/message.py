"""Base classes of generated messages, with their metaclass and the checks of their setters."""

from __future__ import annotations

import builtins as builtins
import math
from array import array
from collections.abc import Iterable, Mapping, Sequence
from collections.abc import Set as AbstractSet
from copy import deepcopy
from sys import byteorder
from typing import TYPE_CHECKING, Any, ClassVar

from daidalos.interfaces.definition import INTEGER_RANGES

if TYPE_CHECKING:
    import numpy

TYPECODES = {
    "float32": "f", "float64": "d", "char": "B", "uint8": "B", "int8": "b", "int16": "h", "uint16": "H",
    "int32": "i", "uint32": "I", "int64": "q", "uint64": "Q",
}  # fmt: skip
_DTYPES = {code: name for name, code in TYPECODES.items() if name != "char"}
_DTYPE_TEXTS = {
    code: f"{'|' if array(code).itemsize == 1 else '<' if byteorder == 'little' else '>'}"
    f"{'f' if code in 'fd' else 'i' if code.islower() else 'u'}{array(code).itemsize}"
    for code in TYPECODES.values()
}
"""What numpy calls the types of arrays in the machine's byte order, which is faster to ask for than their names."""
_AT_ONCE = 4096  # bytes up to which a copy of a copy is faster than a view
_FLOAT32_MAX = 3.4028234663852886e38


class MessageType(type):
    """Metaclass of message, service and action classes; constants and defaults are read-only."""

    _frozen: ClassVar[frozenset[str]] = frozenset()
    # rclpy's type checks look for these on the metaclass; ours need no C library behind them.
    _TYPE_SUPPORT = "daidalos"
    _CREATE_ROS_MESSAGE = _CONVERT_FROM_PY = _CONVERT_TO_PY = _DESTROY_ROS_MESSAGE = "daidalos"

    def __setattr__(cls, name: str, value: object) -> None:
        if name in cls._frozen:
            raise AttributeError(f"'{cls.__name__}.{name}' is a constant")
        super().__setattr__(name, value)

    @classmethod
    def __import_type_support__(mcs) -> None:
        """Do nothing; there is no C type support to import."""


class SlotTypes:
    """Descriptor that computes `SLOT_TYPES` (rosidl_parser's types of the fields) on first access."""

    def __get__(self, instance: object, owner: type[Message]) -> tuple[Any, ...]:
        from rosidl_parser.definition import slot_types

        types: tuple[Any, ...] = slot_types(owner)
        return types


class Message(metaclass=MessageType):
    """Base of all messages: comparison, representation and copying."""

    __slots__ = ()
    SLOT_TYPES = SlotTypes()
    _fields_and_field_types: ClassVar[dict[str, str]] = {}
    _FIELDS: ClassVar[tuple[tuple[str, Any, str, int, int | None], ...]] = ()
    """(name, primitive name or message class, kind, size, string bound) of every field."""
    _TYPE_NAME: ClassVar[str] = ""
    _TYPE_HASH: ClassVar[str] = ""

    @classmethod
    def get_fields_and_field_types(cls) -> dict[str, str]:
        """Return the fields in order, with their types in IDL notation."""
        return dict(cls._fields_and_field_types)

    def __repr__(self) -> str:
        package, kind, _ = type(self)._TYPE_NAME.split("/")
        values = ", ".join(f"{name}={_show(getattr(self, name))}" for name in self._fields_and_field_types)
        return f"{package}.{kind}.{type(self).__name__}({values})"

    def __eq__(self, other: object) -> bool:
        if other.__class__ is not self.__class__:
            return False
        return all(_equal(getattr(self, name), getattr(other, name)) for name in self._fields_and_field_types)

    __hash__ = None  # type: ignore[assignment]

    def __copy__(self) -> Message:
        twin = object.__new__(type(self))
        for name in self._fields_and_field_types:
            setattr(twin, f"_{name}", getattr(self, name))
        return twin

    def __deepcopy__(self, memo: dict[int, Any]) -> Message:
        twin = object.__new__(type(self))
        for name in self._fields_and_field_types:
            setattr(twin, f"_{name}", deepcopy(getattr(self, f"_{name}"), memo))
        return twin


def _show(value: Any) -> str:
    if isinstance(value, array):
        return repr(value.tolist())
    return repr(value)


def _equal(a: Any, b: Any) -> bool:
    try:
        result = a == b
    except ValueError:  # arrays of two shapes
        return False
    return result if isinstance(result, bool) else bool(result.all())


def reject(message: Message, unknown: Mapping[str, object]) -> None:
    """Raise an error for constructor arguments that are not fields.

    Raises
    ------
    AssertionError
        As ROS 2's generated constructors do.
    """
    names = ", ".join(sorted(unknown.keys() - {"check_fields"}))  # Jazzy's constructors take `check_fields`
    if not names:
        return
    fields = ", ".join(message._fields_and_field_types)
    raise AssertionError(f"Invalid arguments passed to constructor: {names}; {type(message).__name__} has {fields}")


def check_bool(name: str, value: object) -> bool:
    """Return `value` if it is a bool, else raise an error."""
    if not isinstance(value, bool):
        raise AssertionError(f"The '{name}' field must be of type 'bool', not {_kind(value)}")
    return value


def check_int(name: str, value: object, base: str) -> int:
    """Return `value` if it is an int in the range of the integer type `base`, else raise an error."""
    if not isinstance(value, int):
        raise AssertionError(f"The '{name}' field must be of type 'int', not {_kind(value)}")
    low, high = INTEGER_RANGES[base]
    if not low <= value <= high:
        raise AssertionError(f"The '{name}' field must be an integer in [{low}, {high}], not {value}")
    return value


def check_byte(name: str, value: object) -> bytes:
    """Return `value` if it is a bytes object of length 1, else raise an error."""
    if not isinstance(value, (bytes, bytearray, memoryview)) or len(value) != 1:
        raise AssertionError(f"The '{name}' field must be of type 'bytes' with length 1, not {_kind(value)}")
    return bytes(value)


def check_float(name: str, value: object, base: str) -> float:
    """Return `value` if it is a float that `base` (float32 or float64) can hold, else raise an error."""
    if not isinstance(value, float):
        hint = f": write {float(value)}" if isinstance(value, int) and not isinstance(value, bool) else ""
        raise AssertionError(f"The '{name}' field must be of type 'float', not {_kind(value)}{hint}")
    if base == "float32" and not -_FLOAT32_MAX <= value <= _FLOAT32_MAX and math.isfinite(value):
        raise AssertionError(f"The '{name}' field must be a float in the range of float32, not {value}")
    return value


def check_string(name: str, value: object, bound: int | None = None) -> str:
    """Return `value` if it is a str of at most `bound` characters, else raise an error."""
    if not isinstance(value, str):
        raise AssertionError(f"The '{name}' field must be of type 'str', not {_kind(value)}")
    if bound is not None and len(value) > bound:
        raise AssertionError(f"The '{name}' field must be string value not longer than {bound}")
    return value


def check_message(name: str, value: Any, kind: type[Message]) -> Any:
    """Return `value` if it is a message of class `kind` or its ``STANDS_FOR`` names that message, else raise an error.

    Such an object is kept as it is, for who reads the message in the same program; it cannot be serialized.
    """
    if not isinstance(value, kind) and getattr(value, "STANDS_FOR", None) != kind._TYPE_NAME:
        raise AssertionError(f"The '{name}' field must be a sub message of type '{kind.__name__}', not {_kind(value)}")
    return value


def check_numbers(name: str, value: object, base: str, upto: int = 0) -> array[Any]:
    """Return an `array.array` of the type `base` with the numbers of a sequence, at most `upto` of them (0: any)."""
    code = TYPECODES[base]
    if not (isinstance(value, array) and value.typecode == code):
        value = _to_array(name, value, base, code)
    if upto and len(value) > upto:
        raise AssertionError(f"The '{name}' field must have at most {upto} values, not {len(value)}")
    return value


def _to_array(name: str, value: Any, base: str, code: str) -> array[Any]:
    data = getattr(value, "dtype", None)
    if getattr(data, "str", None) == _DTYPE_TEXTS[code]:
        if value.nbytes <= _AT_ONCE:
            return array(code, value.tobytes())
        import numpy

        result = array(code)
        result.frombytes(numpy.ascontiguousarray(value).data.cast("B"))
        return result
    if code == "B" and isinstance(value, (bytes, bytearray, memoryview)):
        return array("B", bytes(value))
    check_iterable(name, value)
    try:
        result = array(code, value)
    except (TypeError, OverflowError, ValueError) as error:
        raise AssertionError(f"The '{name}' field must be a sequence of {base}: {error}") from None
    if code == "f":
        for item in value:
            check_float(name, float(item), base)
    return result


def check_array(name: str, value: Any, base: str, size: int) -> numpy.ndarray[Any, Any]:
    """Return exactly `size` numbers as a numpy array of the type `base`."""
    import numpy

    dtype = numpy.dtype(_DTYPES[TYPECODES[base]])
    if not isinstance(value, numpy.ndarray):
        if isinstance(value, (bytes, bytearray, memoryview)) and base in {"uint8", "char"}:
            value = numpy.frombuffer(bytes(value), dtype)
        else:
            value = _array_from(name, value, base, dtype)
    elif value.dtype != dtype:
        raise AssertionError(f"The '{name}' numpy.ndarray() must have the dtype of '{dtype}', not {value.dtype}")
    result: numpy.ndarray[Any, Any] = value
    if result.size != size:
        raise AssertionError(f"The '{name}' array must have a size of {size}, not {result.size}")
    return result


def _array_from(name: str, value: Any, base: str, dtype: numpy.dtype[Any]) -> numpy.ndarray[Any, Any]:
    import numpy

    check_iterable(name, value)
    values = list(value)
    for item in values:
        if base in INTEGER_RANGES:
            check_int(name, int(item) if isinstance(item, numpy.integer) else item, base)
        elif not isinstance(item, (float, numpy.floating)):
            raise AssertionError(f"The '{name}' field must hold values of type 'float', not {_kind(item)}")
        else:
            check_float(name, float(item), base)
    return numpy.array(values, dtype)


def zeros(base: str, size: int) -> numpy.ndarray[Any, Any]:
    """Return `size` zeros of the type `base`, the default of a fixed array."""
    import numpy

    return numpy.zeros(size, _DTYPES[TYPECODES[base]])


def check_list(name: str, value: Any, check: Any, kind: str, size: int) -> Any:
    """Return `value` as a list in which every item passes `check(name, item)`.

    `kind` ("array", "bounded" or "unbounded") and `size` limit its length. A list is kept as it is, so that
    what the caller appends to it later is in the message, as in ROS 2.
    """
    check_iterable(name, value)
    if not isinstance(value, (list, tuple)):
        value = list(value)
    if kind == "array" and len(value) != size:
        raise AssertionError(f"The '{name}' field must have exactly {size} values, not {len(value)}")
    if kind == "bounded" and len(value) > size:
        raise AssertionError(f"The '{name}' field must have at most {size} values, not {len(value)}")
    for item in value:
        check(name, item)
    return value


def check_iterable(name: str, value: object) -> None:
    """Raise an error for values that are not collections: scalars, strings, mappings."""
    wrong = isinstance(value, (str, Mapping)) or not isinstance(value, (Sequence, AbstractSet, Iterable))
    if wrong:
        raise AssertionError(f"The '{name}' field must be a set or sequence, not {_kind(value)}")


def _kind(value: object) -> str:
    return f"'{type(value).__name__}'"


class ServiceType(MessageType):
    """Metaclass of service classes."""


class ActionType(MessageType):
    """Metaclass of action classes."""


class Service(metaclass=ServiceType):
    """Base of all service classes; never instantiated."""

    _TYPE_NAME: ClassVar[str] = ""
    _TYPE_HASH: ClassVar[str] = ""
    Request: ClassVar[Any] = None
    Response: ClassVar[Any] = None
    Event: ClassVar[Any] = None

    def __init__(self) -> None:
        raise NotImplementedError("Service classes can not be instantiated")


class Action(metaclass=ActionType):
    """Base of all action classes; never instantiated."""

    _TYPE_NAME: ClassVar[str] = ""
    _TYPE_HASH: ClassVar[str] = ""
    Goal: ClassVar[Any] = None
    Result: ClassVar[Any] = None
    Feedback: ClassVar[Any] = None
    Impl: ClassVar[Any] = None

    def __init__(self) -> None:
        raise NotImplementedError("Action classes can not be instantiated")
