"""Contents of definitions: fields, constants, messages, services and actions."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import Any

from ._errors import UnknownMessageType
from ._types import (
    PACKAGE_NAME_MESSAGE_TYPE_SEPARATOR,
    PRIMITIVE_TYPES,
    VALID_CONSTANT_NAME_PATTERN,
    VALID_FIELD_NAME_PATTERN,
    BaseType,
    Type,
    is_valid_constant_name,
    is_valid_field_name,
)
from ._values import parse_primitive_value_string, parse_value_string


class Constant:
    """Named value.

    Parameters
    ----------
    primitive_type, name, value_string
        Its type without a package, its name and its value as text.
    """

    __slots__ = ("annotations", "name", "type", "value")

    def __init__(self, primitive_type: str, name: str, value_string: str) -> None:
        if primitive_type not in PRIMITIVE_TYPES:
            raise TypeError(f"the constant type '{primitive_type}' must be a primitive type")
        _check_name(name, is_valid_constant_name(name), "constant", VALID_CONSTANT_NAME_PATTERN)
        if value_string is None:
            raise ValueError("the constant value must not be 'None'")
        self.type = primitive_type
        self.name = name
        self.value = parse_primitive_value_string(Type(primitive_type), value_string)
        self.annotations: dict[str, Any] = {}

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Constant) and str(self) == str(other)

    __hash__ = None  # type: ignore[assignment]  # it can change

    def __str__(self) -> str:
        value = f"'{self.value}'" if self.type in ("string", "wstring") else self.value
        return f"{self.type} {self.name}={value}"


def _check_name(name: str, good: bool, what: str, pattern: re.Pattern[str]) -> None:
    if not good:
        raise NameError(f"'{name}' is an invalid {what} name. It should have the pattern '{pattern.pattern}'")


class Field:
    """Field of a message.

    Parameters
    ----------
    type_, name, default_value_string
        Its type, its name and its default value as text.
    """

    def __init__(self, type_: Type, name: str, default_value_string: str | None = None) -> None:
        if not isinstance(type_, Type):
            raise TypeError(f"the field type '{type_}' must be a 'Type' instance")
        _check_name(name, is_valid_field_name(name), "field", VALID_FIELD_NAME_PATTERN)
        self.type = type_
        self.name = name
        self.default_value = None if default_value_string is None else parse_value_string(type_, default_value_string)
        self.annotations: dict[str, Any] = {}

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Field) and (self.type, self.name, self.default_value) == (
            other.type,
            other.name,
            other.default_value,
        )

    __hash__ = None  # type: ignore[assignment]  # it can change

    def __str__(self) -> str:
        if self.default_value is None:
            return f"{self.type} {self.name}"
        is_text = self.type.type in ("string", "wstring") and not self.type.is_array
        return f"{self.type} {self.name} {repr(self.default_value) if is_text else self.default_value}"


class MessageSpecification:
    """Message: its name, fields and constants.

    Raises
    ------
    TypeError, ValueError
        For items that are none, and for names that occur twice.
    """

    def __init__(self, pkg_name: str, msg_name: str, fields: Iterable[Field], constants: Iterable[Constant]) -> None:
        self.base_type = BaseType(f"{pkg_name}{PACKAGE_NAME_MESSAGE_TYPE_SEPARATOR}{msg_name}")
        self.msg_name = msg_name
        self.annotations: dict[str, Any] = {}
        self.fields: list[Field] = _unique("field", fields, Field)
        self.constants: list[Constant] = _unique("constant", constants, Constant)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, MessageSpecification) and (
            (self.base_type, self.fields, self.constants) == (other.base_type, other.fields, other.constants)
        )

    __hash__ = None  # type: ignore[assignment]  # it can change

    def __str__(self) -> str:
        return "\n".join((f"# {self.base_type}", *map(str, self.constants), *map(str, self.fields)))


def _unique(what: str, items: Iterable[Any], kind: type) -> list[Any]:
    found = list(items)
    for index, item in enumerate(found):
        if not isinstance(item, kind):
            raise TypeError(f"{what} {index} must be a '{kind.__name__}' instance")
    names = [item.name for item in found]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise ValueError(f"the {what}s iterable contains duplicate names: {', '.join(twice)}")
    return found


class ServiceSpecification:
    """Service: its name, request and response."""

    def __init__(
        self, pkg_name: str, srv_name: str, request: MessageSpecification, response: MessageSpecification
    ) -> None:
        self.pkg_name = pkg_name
        self.srv_name = srv_name
        self.request = request
        self.response = response

    def __str__(self) -> str:
        return f"# {self.pkg_name}/{self.srv_name}\n{self.request}\n---\n{self.response}"


class ActionSpecification:
    """Action: its name, goal, result and feedback."""

    def __init__(
        self,
        pkg_name: str,
        action_name: str,
        goal: MessageSpecification,
        result: MessageSpecification,
        feedback: MessageSpecification,
    ) -> None:
        self.pkg_name = pkg_name
        self.action_name = action_name
        self.goal = goal
        self.result = result
        self.feedback = feedback


def validate_field_types(
    spec: MessageSpecification | ServiceSpecification | ActionSpecification, known_msg_types: Sequence[BaseType]
) -> None:
    """Raise UnknownMessageType for a field with a type of a package that is not known."""
    if isinstance(spec, MessageSpecification):
        what, messages = "Message", [spec]
    elif isinstance(spec, ServiceSpecification):
        what, messages = "Service", [spec.request, spec.response]
    else:
        what, messages = "Action", [spec.goal, spec.result, spec.feedback]
    for field in (field for message in messages for field in message.fields):
        base = BaseType(BaseType.__str__(field.type))
        if not base.is_primitive_type() and base not in known_msg_types:
            raise UnknownMessageType(f"{what} interface '{base}' contains an unknown field type: {field}")
