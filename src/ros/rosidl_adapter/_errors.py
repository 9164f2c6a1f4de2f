"""Errors of definitions."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ._types import Type


class InvalidSpecification(Exception):
    """Error of a definition."""


class InvalidActionSpecification(InvalidSpecification):
    """Error of an action without the three parts."""


class InvalidServiceSpecification(InvalidSpecification):
    """Error of a service without the two parts."""


class InvalidResourceName(InvalidSpecification):
    """Error of a name of a package or a message."""


class InvalidFieldDefinition(InvalidSpecification):
    """Error of a line that is neither a field nor a constant."""


class UnknownMessageType(InvalidSpecification):
    """Error of a field whose type is not known."""


class InvalidValue(Exception):
    """Error of a value that is not one of its type.

    Parameters
    ----------
    type_
        The type.
    value_string
        The value as text.
    message_suffix
        What is expected.
    """

    def __init__(self, type_: Type | str, value_string: str, message_suffix: str | None = None) -> None:
        reason = f": {message_suffix}" if message_suffix is not None else ""
        super().__init__(f"value '{value_string}' can not be converted to type '{type_}'{reason}")
