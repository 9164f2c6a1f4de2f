"""Conditions on messages in the filter language of DDS 1.4, annex B: ``pose.x > %0 AND frame LIKE 'base%'``."""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

from lark import Lark, Token, Transformer, UnexpectedCharacters, UnexpectedToken, v_args
from lark.exceptions import VisitError

from daidalos.interfaces.codec import codec_of

Condition = Callable[[Any], bool]
Value = Callable[[Any], Any]

_GRAMMAR = r"""
?start: either
?either: both ("OR"i both)*
?both: one ("AND"i one)*
?one: "NOT"i one -> negated | "(" either ")" | comparison
comparison: value OPERATOR value -> compared
    | value "BETWEEN"i value "AND"i value -> within
    | value "NOT"i "BETWEEN"i value "AND"i value -> outside
?value: FIELD -> field | PARAMETER -> parameter | (NUMBER | TEXT | BOOLEAN) -> literal
OPERATOR: /<>|!=|<=|>=|=|<|>|LIKE\b/i
BOOLEAN.1: /(TRUE|FALSE)\b/i
NUMBER: /[-+]?(0x[0-9a-f]+|(\d+\.?\d*|\.\d+)(e[-+]?\d+)?)/i
TEXT: /'[^']*'|`[^']*'/
PARAMETER: /%\d+/
FIELD: /[a-z_]\w*(\[\d+\])?(\.[a-z_]\w*(\[\d+\])?)*/i
%ignore /\s+/
"""
_EXPECTED = {
    "FIELD": "a field or a value",
    "OPERATOR": "an operator",
    "BETWEEN": "'BETWEEN'",
    "RPAR": "')'",
    "$END": "the end",
    "AND": "'AND'",
}
"""What an error names as expected: the first of these terminals that the grammar allows at that place."""
_OPERATORS: dict[str, Callable[[Any, Any], bool]] = {
    "=": operator.eq,
    "<>": operator.ne,
    "!=": operator.ne,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "LIKE": lambda value, pattern: re.fullmatch(_like(pattern), str(value), re.DOTALL) is not None,
}


class ContentFilterError(ValueError):
    """An expression cannot be understood."""


def parse(expression: str, parameters: Sequence[str]) -> Condition:
    """Return the condition that an expression states.

    Raises
    ------
    ContentFilterError
        Telling where the expression is wrong, or which parameter is missing.
    """
    try:
        condition: Condition = _Conditions(expression, parameters).transform(_parser().parse(expression))
    except UnexpectedCharacters as error:
        raise _fault(expression, "a field, a value or an operator", error.pos_in_stream) from None
    except UnexpectedToken as error:
        expected = next(words for terminal, words in _EXPECTED.items() if terminal in error.expected)
        raise _fault(expression, expected, error.pos_in_stream if error.token else len(expression)) from None
    except VisitError as error:
        raise error.orig_exc from None
    return condition


def filtered(
    take: Callable[[], tuple[Any, Any] | None],
    message_type: Any,
    raw: bool,
    expression: str,
    parameters: Sequence[str],
) -> Callable[[], tuple[Any, Any] | None]:
    """Return `take` without the messages that do not fulfil a condition.

    Raises
    ------
    ContentFilterError
        When the expression cannot be understood, or does not fit the type.
    """
    condition = parse(expression, parameters)
    try:
        condition(message_type())
    except IndexError:
        pass  # a sequence that is empty by default
    except (AttributeError, TypeError) as error:
        raise ContentFilterError(
            f"content filter '{expression}' does not fit {message_type.__name__}: {error}"
        ) from None
    decode = codec_of(message_type).decode

    def take_wanted() -> tuple[Any, Any] | None:
        while True:
            taken = take()
            if taken is None or _holds(condition, decode(taken[0]) if raw else taken[0]):
                return taken

    return take_wanted


def _holds(condition: Condition, message: Any) -> bool:
    try:
        return condition(message)
    except IndexError:
        return False  # it asks for an element that this message lacks


def _fault(expression: str, expected: str, position: int | None) -> ContentFilterError:
    return ContentFilterError(f"content filter '{expression}': expected {expected} at character {(position or 0) + 1}")


@cache
def _parser() -> Lark:
    return Lark(_GRAMMAR, parser="lalr")


@v_args(inline=True)
class _Conditions(Transformer[Token, Condition]):
    """Transformer of the parts of an expression to functions of a message."""

    def __init__(self, expression: str, parameters: Sequence[str]) -> None:
        super().__init__()
        self._expression = expression
        self._parameters = parameters

    def either(self, *parts: Condition) -> Condition:
        return lambda message: any(part(message) for part in parts)

    def both(self, *parts: Condition) -> Condition:
        return lambda message: all(part(message) for part in parts)

    def negated(self, inner: Condition) -> Condition:
        return lambda message: not inner(message)

    def compared(self, left: Value, name: Token, right: Value) -> Condition:
        compare = _OPERATORS[name.upper()]
        return lambda message: compare(left(message), right(message))

    def within(self, value: Value, low: Value, high: Value) -> Condition:
        return lambda message: low(message) <= value(message) <= high(message)

    def outside(self, value: Value, low: Value, high: Value) -> Condition:
        return self.negated(self.within(value, low, high))

    def field(self, path: Token) -> Value:
        return _field(path)

    def literal(self, text: Token) -> Value:
        constant = _constant(text)
        return lambda message: constant

    def parameter(self, text: Token) -> Value:
        number = int(text[1:])
        if number >= len(self._parameters):
            raise ContentFilterError(
                f"content filter '{self._expression}': there is no parameter {text}, only {len(self._parameters)}"
            )
        constant = _constant(self._parameters[number])
        return lambda message: constant


def _constant(text: str) -> Any:
    """Return the value of a literal; what is neither a number nor a Boolean nor in quotes is a string as it stands."""
    text = text.strip()
    if len(text) >= 2 and text[0] in "'`" and text[-1] == "'":
        return text[1:-1]
    if text.upper() in ("TRUE", "FALSE"):
        return text.upper() == "TRUE"
    for kind in (lambda digits: int(digits, 0), float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text


def _field(path: str) -> Value:
    """Return what reads a field, such as ``poses[2].position.x``."""
    steps = [(name, int(index) if index else None) for name, index in re.findall(r"(\w+)(?:\[(\d+)\])?", path)]

    def read(message: Any) -> Any:
        for name, index in steps:
            message = getattr(message, name)
            if index is not None:
                message = message[index]
        return message

    return read


def _like(pattern: str) -> str:
    """Return the regular expression of a LIKE pattern: ``%`` is any text, ``_`` any character."""
    return "".join({"%": ".*", "_": "."}.get(char, re.escape(char)) for char in str(pattern))
