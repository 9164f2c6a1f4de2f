"""Names and types in definitions."""

from __future__ import annotations

import re
from typing import Any

from ._errors import InvalidResourceName

PACKAGE_NAME_MESSAGE_TYPE_SEPARATOR = "/"
COMMENT_DELIMITER = "#"
CONSTANT_SEPARATOR = "="
ARRAY_UPPER_BOUND_TOKEN = "<="
STRING_UPPER_BOUND_TOKEN = "<="
SERVICE_REQUEST_RESPONSE_SEPARATOR = "---"
SERVICE_REQUEST_MESSAGE_SUFFIX = "_Request"
SERVICE_RESPONSE_MESSAGE_SUFFIX = "_Response"
SERVICE_EVENT_MESSAGE_SUFFIX = "_Event"
ACTION_REQUEST_RESPONSE_SEPARATOR = "---"
ACTION_GOAL_SUFFIX = "_Goal"
ACTION_RESULT_SUFFIX = "_Result"
ACTION_FEEDBACK_SUFFIX = "_Feedback"
ACTION_GOAL_SERVICE_SUFFIX = "_Goal"
ACTION_RESULT_SERVICE_SUFFIX = "_Result"
ACTION_FEEDBACK_MESSAGE_SUFFIX = "_Feedback"
PRIMITIVE_TYPES = [
    "bool", "byte", "char", "float32", "float64", "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64",
    "uint64", "string", "wstring", "duration", "time",
]  # fmt: skip
"""Names of types without a package; `duration` and `time` are of ROS 1."""

VALID_PACKAGE_NAME_PATTERN = re.compile(r"^(?!.*__)(?!.*_$)[a-z][a-z0-9_]*$")
VALID_FIELD_NAME_PATTERN = VALID_PACKAGE_NAME_PATTERN
VALID_MESSAGE_NAME_PATTERN = re.compile(r"^[A-Z][A-Za-z0-9]*$")
VALID_CONSTANT_NAME_PATTERN = re.compile(r"^[A-Z]([A-Z0-9_]?[A-Z0-9]+)*$")

_DERIVED = (
    SERVICE_REQUEST_MESSAGE_SUFFIX,
    SERVICE_RESPONSE_MESSAGE_SUFFIX,
    ACTION_GOAL_SERVICE_SUFFIX,
    ACTION_RESULT_SERVICE_SUFFIX,
    ACTION_FEEDBACK_MESSAGE_SUFFIX,
)


def is_valid_package_name(name: str) -> bool:
    """Return whether a name can be one of a package; raises InvalidResourceName for what is not text."""
    return _fits(VALID_PACKAGE_NAME_PATTERN, name)


def is_valid_field_name(name: str) -> bool:
    """Return whether a name can be one of a field; raises InvalidResourceName for what is not text."""
    return _fits(VALID_FIELD_NAME_PATTERN, name)


def is_valid_message_name(name: str) -> bool:
    """Return whether a name can be one of a message; raises InvalidResourceName for what is not text."""
    if not isinstance(name, str):
        raise InvalidResourceName(name)
    name = name.removeprefix("Sample_")
    for suffix in _DERIVED:
        name = name.removesuffix(suffix)
    return _fits(VALID_MESSAGE_NAME_PATTERN, name)


def is_valid_constant_name(name: str) -> bool:
    """Return whether a name can be one of a constant; raises InvalidResourceName for what is not text."""
    return _fits(VALID_CONSTANT_NAME_PATTERN, name)


def _fits(pattern: re.Pattern[str], name: Any) -> bool:
    if not isinstance(name, str):
        raise InvalidResourceName(name)
    return pattern.fullmatch(name) is not None


class BaseType:
    """Type of one value.

    Parameters
    ----------
    type_string
        Such as ``float64``, ``string<=5`` or ``geometry_msgs/Point``.
    context_package_name
        Package of types that name none.
    """

    __slots__ = ("pkg_name", "string_upper_bound", "type")

    def __init__(self, type_string: str, context_package_name: str | None = None) -> None:
        self.pkg_name: str | None = None
        self.type = type_string
        self.string_upper_bound: int | None = None
        if type_string in PRIMITIVE_TYPES:
            return
        name, separator, bound = type_string.partition(STRING_UPPER_BOUND_TOKEN)
        if separator and name in ("string", "wstring"):
            self.type = name
            self.string_upper_bound = _positive(bound, f"the upper bound of the string type '{type_string}'")
            return
        parts = type_string.split(PACKAGE_NAME_MESSAGE_TYPE_SEPARATOR)
        if len(parts) == 1 and context_package_name is not None:
            parts = [context_package_name, type_string]
        if len(parts) != 2:
            raise InvalidResourceName(type_string)
        self.pkg_name, self.type = parts
        for what, good, pattern in (
            (self.pkg_name, is_valid_package_name(self.pkg_name), VALID_PACKAGE_NAME_PATTERN),
            (self.type, is_valid_message_name(self.type), VALID_MESSAGE_NAME_PATTERN),
        ):
            if not good:
                raise InvalidResourceName(
                    f"'{what}' is an invalid name. It should have the pattern '{pattern.pattern}'"
                )

    def is_primitive_type(self) -> bool:
        """Return whether the type has no package."""
        return self.pkg_name is None

    def _key(self) -> tuple[Any, ...]:
        return self.pkg_name, self.type, self.string_upper_bound

    def __eq__(self, other: object) -> bool:
        return isinstance(other, BaseType) and type(self) is type(other) and self._key() == other._key()

    def __hash__(self) -> int:
        return hash(str(self))

    def __str__(self) -> str:
        if self.pkg_name is not None:
            return f"{self.pkg_name}/{self.type}"
        bound = self.string_upper_bound
        return f"{self.type}{STRING_UPPER_BOUND_TOKEN}{bound}" if bound else self.type


def _positive(text: str, what: str) -> int:
    if not text.strip().isdigit() or int(text) == 0:
        raise TypeError(f"{what} must be a valid integer value > 0")
    return int(text)


class Type(BaseType):
    """Type of a field: one value, or an array such as ``float64[3]``, ``float64[<=3]`` or ``float64[]``.

    Parameters
    ----------
    type_string, context_package_name
        See `BaseType`.
    """

    __slots__ = ("array_size", "is_array", "is_upper_bound")

    def __init__(self, type_string: str, context_package_name: str | None = None) -> None:
        self.is_array = type_string.endswith("]")
        self.array_size: int | None = None
        self.is_upper_bound = False
        if self.is_array:
            if "[" not in type_string:
                raise TypeError(f"the type {type_string} ends with ']' but does not contain a '['")
            whole, (type_string, _, size) = type_string, type_string[:-1].rpartition("[")
            self.is_upper_bound = size.startswith(ARRAY_UPPER_BOUND_TOKEN)
            if size:
                size = size.removeprefix(ARRAY_UPPER_BOUND_TOKEN)
                self.array_size = _positive(size, f"the size of array type '{whole}'")
        super().__init__(type_string, context_package_name)

    def is_dynamic_array(self) -> bool:
        """Return whether it is an array whose size may differ."""
        return self.is_array and (not self.array_size or self.is_upper_bound)

    def is_fixed_size_array(self) -> bool:
        """Return whether it is an array of one size."""
        return self.is_array and bool(self.array_size) and not self.is_upper_bound

    def _key(self) -> tuple[Any, ...]:
        return *super()._key(), self.is_array, self.array_size, self.is_upper_bound

    def __eq__(self, other: object) -> bool:
        return super().__eq__(other)

    def __hash__(self) -> int:
        return hash(str(self))

    def __str__(self) -> str:
        bound = ARRAY_UPPER_BOUND_TOKEN if self.is_upper_bound else ""
        return super().__str__() + (f"[{bound}{self.array_size or ''}]" if self.is_array else "")
