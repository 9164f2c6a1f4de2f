"""Conditions on messages in the filter language of DDS 1.4, annex B: ``pose.x > %0 AND frame LIKE 'base%'``."""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Sequence
from typing import Any

from daidalos.interfaces.codec import codec_of

Condition = Callable[[Any], bool]
Value = Callable[[Any], Any]

_TOKEN = re.compile(
    r"\s*(?:(?P<number>[-+]?(?:0[xX][0-9a-fA-F]+|(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?))"
    r"|(?P<text>'[^']*'|`[^']*')"
    r"|(?P<parameter>%\d+)"
    r"|(?P<operator><>|!=|<=|>=|=|<|>)"
    r"|(?P<bracket>[()])"
    r"|(?P<name>[A-Za-z_]\w*(?:\[\d+\])?(?:\.[A-Za-z_]\w*(?:\[\d+\])?)*))"
)
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
    reader = _Reader(expression, parameters)
    condition = reader.either()
    if reader.kind:
        raise reader.error("the end")
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


class _Reader:
    """Reads an expression token by token; `kind` and `text` are the token that comes next."""

    def __init__(self, expression: str, parameters: Sequence[str]) -> None:
        self._expression = expression
        self._parameters = parameters
        self._end = 0
        self.next()

    def next(self) -> str:
        """Go on; returns the token that came before."""
        before = getattr(self, "text", "")
        self._start = self._end
        match = _TOKEN.match(self._expression, self._end)
        if match:
            self.kind, self.text, self._end = str(match.lastgroup), match[match.lastgroup or 0], match.end()
        elif self._expression[self._end :].strip():
            self.kind = self.text = "?"
            raise self.error("a field, a value or an operator")
        else:
            self.kind = self.text = ""
        return before

    def error(self, expected: str) -> ContentFilterError:
        """Return what tells that something else was expected here."""
        return ContentFilterError(
            f"content filter '{self._expression}': expected {expected} at character {self._start + 1}"
        )

    def accept(self, word: str) -> bool:
        """Go on if the next token is this keyword or bracket."""
        if self.text.upper() != word or self.kind not in ("name", "bracket"):
            return False
        self.next()
        return True

    def expect(self, word: str) -> None:
        """Go on over this keyword or bracket."""
        if not self.accept(word):
            raise self.error(f"'{word}'")

    def either(self) -> Condition:
        """Read conditions joined by OR."""
        parts = [self.both()]
        while self.accept("OR"):
            parts.append(self.both())
        return parts[0] if len(parts) == 1 else lambda message: any(part(message) for part in parts)

    def both(self) -> Condition:
        """Read conditions joined by AND."""
        parts = [self.one()]
        while self.accept("AND"):
            parts.append(self.one())
        return parts[0] if len(parts) == 1 else lambda message: all(part(message) for part in parts)

    def one(self) -> Condition:
        """Read one condition, perhaps in brackets or after NOT."""
        if self.accept("NOT"):
            inner = self.one()
            return lambda message: not inner(message)
        if self.accept("("):
            inner = self.either()
            self.expect(")")
            return inner
        return self.comparison()

    def comparison(self) -> Condition:
        """Read ``value operator value`` or ``value [NOT] BETWEEN value AND value``."""
        left = self.value()
        negated = self.accept("NOT")
        if negated or self.text.upper() == "BETWEEN":
            self.expect("BETWEEN")
            low = self.value()
            self.expect("AND")
            high = self.value()
            return lambda message: (low(message) <= left(message) <= high(message)) is not negated
        if self.kind != "operator" and self.text.upper() != "LIKE":
            raise self.error("an operator")
        compare = _OPERATORS[self.next().upper()]
        right = self.value()
        return lambda message: compare(left(message), right(message))

    def value(self) -> Value:
        """Read a field's name, a literal or a parameter."""
        kind, text = self.kind, self.text
        if kind not in ("number", "text", "parameter", "name"):
            raise self.error("a field or a value")
        self.next()
        if kind == "parameter":
            number = int(text[1:])
            if number >= len(self._parameters):
                raise ContentFilterError(
                    f"content filter '{self._expression}': there is no parameter {text}, only {len(self._parameters)}"
                )
            constant = _constant(self._parameters[number])
        elif kind == "name" and text.upper() not in ("TRUE", "FALSE"):
            return _field(text)
        else:
            constant = _constant(text)
        return lambda message: constant


def _constant(text: str) -> Any:
    """Return the value of a literal; what is no number, no boolean and in no quotes is a string as it stands."""
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
