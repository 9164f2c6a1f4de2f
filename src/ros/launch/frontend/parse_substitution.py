r"""The substitutions in a text of a launch file: `prefix_$(name argument "another argument")_suffix`.

    template      = { escape | substitution | any other character }
    substitution  = "$(" name { space argument } ")"
    argument      = { escape | substitution | quoted | "(" argument ")" | any other character }
    quoted        = "'" { escape | substitution | other } "'" | '"' { escape | substitution | other } '"'
    escape        = "\" any character

Quotes only group inside of a substitution; outside they are ordinary characters, and so are those of the other
kind inside of quotes. An escaped character stands for itself.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from ..substitution import Substitution
from ..substitutions.text_substitution import TextSubstitution
from ..utilities.type_utils import (
    NormalizedValueType,
    SomeValueType,
    is_instance_of_valid_type,
    normalize_typed_substitution,
)
from .expose import instantiate_substitution

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")


def parse_substitution(string_value: str) -> list[Substitution]:
    """Return the substitutions and the plain text between them.

    Raises
    ------
    ValueError
        If a substitution is malformed.
    """
    if not string_value:
        return [TextSubstitution(text=string_value)]
    return _Reader(string_value).read_until("")


def parse_if_substitutions(value: SomeValueType) -> NormalizedValueType:
    """Return a value whose texts are replaced by the substitutions in them; numbers, truths and plain texts stay.

    Raises
    ------
    ValueError
        If a substitution is malformed, or if the items of a list are not of one type.
    """
    if isinstance(value, str):
        return _parse_if_any(value)
    if not isinstance(value, Iterable) or isinstance(value, Path | Substitution):
        return normalize_typed_substitution(value, None)
    parsed: list[Any] = [_parse_if_any(item) if isinstance(item, str) else item for item in value]
    if not is_instance_of_valid_type([item for item in parsed if not isinstance(item, list)]):
        raise ValueError(f"the items of {value!r} are not of one type")
    return parsed


def _parse_if_any(text: str) -> str | list[Substitution]:
    parts = parse_substitution(text)
    if len(parts) == 1 and isinstance(parts[0], TextSubstitution):
        return parts[0].text
    return parts


def replace_escaped_characters(data: str) -> str:
    """Return a text in which every escaped character stands for itself."""
    return re.sub(r"\\(.)", r"\1", data, flags=re.DOTALL)


class _Reader:
    """A position in a text, and the rules to read on from there."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.at = 0
        self.quotes = "'\""  # those that group here

    def read_until(self, end: str) -> list[Substitution]:
        """Read text and substitutions up to one of some characters, or to the end of the text."""
        parts = _Parts()
        while self.at < len(self.text) and self.text[self.at] not in end:
            if self.text.startswith("$(", self.at):
                parts.add(self.read_substitution())
            else:
                parts.write(self.read_character())
        return parts.finish()

    def read_character(self) -> str:
        character = self.text[self.at]
        if character == "\\" and self.at + 1 < len(self.text):
            self.at += 1
            character = self.text[self.at]
        self.at += 1
        return character

    def read_substitution(self) -> Substitution:
        start = self.at
        self.at += len("$(")
        self.skip_space()
        name = _NAME.match(self.text, self.at)
        if name is None:
            raise self.error(start, "the name of a substitution is missing after '$('")
        self.at = name.end()
        if self.peek() and not self.peek().isspace() and self.peek() != ")":
            raise self.error(start, f"'{self.peek()}' cannot follow the substitution's name '{name[0]}'")
        arguments: list[list[Substitution]] = []
        self.skip_space()
        while self.peek() and self.peek() != ")":
            arguments.append(self.read_argument(start))
            self.skip_space()
        if not self.peek():
            raise self.error(start, f"the ')' that ends '$({name[0]}' is missing")
        self.at += 1
        return instantiate_substitution(name[0], arguments)

    def read_argument(self, start: int) -> list[Substitution]:
        parts = _Parts()
        depth = 0
        while self.peek() and not (depth == 0 and (self.peek().isspace() or self.peek() == ")")):
            if self.text.startswith("$(", self.at):
                parts.add(self.read_substitution())
            elif self.peek() in self.quotes:
                quote, outer = self.peek(), self.quotes
                self.at += 1
                self.quotes = quote
                parts.extend(self.read_until(quote))
                self.quotes = outer
                if not self.peek():
                    raise self.error(start, f"the closing {quote} is missing")
                self.at += 1
            else:
                depth += {"(": 1, ")": -1}.get(self.peek(), 0)
                parts.write(self.read_character())
        return parts.finish()

    def skip_space(self) -> None:
        while self.peek().isspace():
            self.at += 1

    def peek(self) -> str:
        return self.text[self.at : self.at + 1]

    def error(self, start: int, reason: str) -> ValueError:
        return ValueError(f"malformed substitution at character {start + 1} of '{self.text}': {reason}")


class _Parts:
    """Substitutions in a row, with the plain text between them in one piece each."""

    def __init__(self) -> None:
        self.substitutions: list[Substitution] = []
        self.plain = ""

    def write(self, text: str) -> None:
        self.plain += text

    def add(self, substitution: Substitution) -> None:
        self.flush()
        self.substitutions.append(substitution)

    def extend(self, substitutions: list[Substitution]) -> None:
        for substitution in substitutions:
            if isinstance(substitution, TextSubstitution):
                self.write(substitution.text)
            else:
                self.add(substitution)

    def flush(self) -> None:
        if self.plain:
            self.substitutions.append(TextSubstitution(text=self.plain))
            self.plain = ""

    def finish(self) -> list[Substitution]:
        self.flush()
        return self.substitutions or [TextSubstitution(text="")]
