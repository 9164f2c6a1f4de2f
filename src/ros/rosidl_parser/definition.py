"""The classes by which `SLOT_TYPES` of a message describes its fields."""

from __future__ import annotations

from typing import Any

BOOLEAN_TYPE = "boolean"
OCTET_TYPE = "octet"
CHARACTER_TYPES = ("char", "wchar")
SIGNED_NONEXPLICIT_INTEGER_TYPES = ("short", "long", "long long")
UNSIGNED_NONEXPLICIT_INTEGER_TYPES = ("unsigned short", "unsigned long", "unsigned long long")
SIGNED_EXPLICIT_INTEGER_TYPES = ("int8", "int16", "int32", "int64")
UNSIGNED_EXPLICIT_INTEGER_TYPES = ("uint8", "uint16", "uint32", "uint64")
SIGNED_INTEGER_TYPES = (*SIGNED_NONEXPLICIT_INTEGER_TYPES, *SIGNED_EXPLICIT_INTEGER_TYPES)
UNSIGNED_INTEGER_TYPES = (*UNSIGNED_NONEXPLICIT_INTEGER_TYPES, *UNSIGNED_EXPLICIT_INTEGER_TYPES)
INTEGER_TYPES = (*SIGNED_INTEGER_TYPES, *UNSIGNED_INTEGER_TYPES)
FLOATING_POINT_TYPES = ("float", "double", "long double")
BASIC_TYPES = (*INTEGER_TYPES, *FLOATING_POINT_TYPES, *CHARACTER_TYPES, BOOLEAN_TYPE, OCTET_TYPE)

_BASIC_NAMES = {"bool": "boolean", "byte": "octet", "char": "uint8", "float32": "float", "float64": "double"}


class AbstractType:
    """Base of all types: equal when class and attributes are."""

    __slots__ = ()

    def _key(self) -> tuple[Any, ...]:
        return tuple(getattr(self, name) for kind in type(self).__mro__ for name in getattr(kind, "__slots__", ()))

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and self._key() == other._key()

    def __hash__(self) -> int:
        return hash((type(self), self._key()))

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(map(repr, self._key()))})"


class AbstractNestableType(AbstractType):
    """Base of the types that arrays and sequences can hold."""

    __slots__ = ()


class BasicType(AbstractNestableType):
    """A number, a boolean or an octet."""

    __slots__ = ("typename",)

    def __init__(self, typename: str) -> None:
        self.typename = typename


class AbstractGenericString(AbstractNestableType):
    """Base of all strings."""

    __slots__ = ()

    def has_maximum_size(self) -> bool:
        """Return whether the string is bounded."""
        return hasattr(self, "maximum_size")


class AbstractString(AbstractGenericString):
    """Base of strings of 8-bit characters."""

    __slots__ = ()


class AbstractWString(AbstractGenericString):
    """Base of strings of wide characters."""

    __slots__ = ()


class BoundedString(AbstractString):
    """A string of at most `maximum_size` characters."""

    __slots__ = ("maximum_size",)

    def __init__(self, maximum_size: int) -> None:
        self.maximum_size = maximum_size


class UnboundedString(AbstractString):
    """A string of any length."""

    __slots__ = ()


class BoundedWString(AbstractWString):
    """A wide string of at most `maximum_size` characters."""

    __slots__ = ("maximum_size",)

    def __init__(self, maximum_size: int) -> None:
        self.maximum_size = maximum_size


class UnboundedWString(AbstractWString):
    """A wide string of any length."""

    __slots__ = ()


class NamedType(AbstractNestableType):
    """A type known by its name."""

    __slots__ = ("name",)

    def __init__(self, name: str) -> None:
        self.name = name


class NamespacedType(AbstractNestableType):
    """A message: `namespaces` such as ['geometry_msgs', 'msg'] and `name` such as 'Point'."""

    __slots__ = ("name", "namespaces")

    def __init__(self, namespaces: list[str], name: str) -> None:
        self.namespaces = namespaces
        self.name = name

    def _key(self) -> tuple[Any, ...]:
        return (tuple(self.namespaces), self.name)

    def namespaced_name(self) -> tuple[str, ...]:
        """Return namespaces and name as one tuple."""
        return (*self.namespaces, self.name)


class AbstractNestedType(AbstractType):
    """Base of arrays and sequences of `value_type`."""

    __slots__ = ("value_type",)

    def __init__(self, value_type: AbstractNestableType) -> None:
        self.value_type = value_type

    def has_maximum_size(self) -> bool:
        """Return whether the number of values is limited."""
        return hasattr(self, "maximum_size") or hasattr(self, "size")


class Array(AbstractNestedType):
    """Exactly `size` values."""

    __slots__ = ("size",)

    def __init__(self, value_type: AbstractNestableType, size: int) -> None:
        super().__init__(value_type)
        self.size = size


class AbstractSequence(AbstractNestedType):
    """Base of sequences."""

    __slots__ = ()


class BoundedSequence(AbstractSequence):
    """At most `maximum_size` values."""

    __slots__ = ("maximum_size",)

    def __init__(self, value_type: AbstractNestableType, maximum_size: int) -> None:
        super().__init__(value_type)
        self.maximum_size = maximum_size


class UnboundedSequence(AbstractSequence):
    """Any number of values."""

    __slots__ = ()


def slot_types(message_type: Any) -> tuple[AbstractType, ...]:
    """Describe the fields of a generated message class, in their order."""
    return tuple(_slot_type(base, kind, size, bound) for _, base, kind, size, bound in message_type._FIELDS)


def _slot_type(base: Any, kind: str, size: int, bound: int | None) -> AbstractType:
    one: AbstractNestableType
    if not isinstance(base, str):
        package, folder, name = base._TYPE_NAME.split("/")
        one = NamespacedType([package, folder], name)
    elif base == "string":
        one = UnboundedString() if bound is None else BoundedString(bound)
    elif base == "wstring":
        one = UnboundedWString() if bound is None else BoundedWString(bound)
    else:
        one = BasicType(_BASIC_NAMES.get(base, base))
    if kind == "array":
        return Array(one, size)
    if kind == "bounded":
        return BoundedSequence(one, size)
    return UnboundedSequence(one) if kind == "unbounded" else one
