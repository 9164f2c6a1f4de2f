"""Values of aggregates of literals, such as those of positions."""

from __future__ import annotations

import functools
import re
from typing import Any

from daidalos.industry.rapid.lexing import number_value, string_value

_PART = re.compile(r'\s*+(?:(")(?:[^"]|"")*+"|([\[\],])|([^\s\[\],]++))')


@functools.lru_cache(4096)
def _parsed(text: str) -> list[Any]:
    stack: list[list[Any]] = [[]]
    for match in _PART.finditer(text):
        symbol, word = match[2], match[3]
        if symbol == "[":
            stack.append([])
        elif symbol == "]":
            finished = stack.pop()
            stack[-1].append(finished)
        elif match[1]:
            stack[-1].append(string_value(match[0].strip()))
        elif word:
            stack[-1].append(literal_value(word))
    value: list[Any] = stack[0][0]
    return value


def literal_value(word: str) -> Any:
    """Return the value of a number, with its sign, or of TRUE and FALSE."""
    upper = word.upper()
    if upper in ("TRUE", "FALSE"):
        return upper == "TRUE"
    sign = -1.0 if word[0] == "-" else 1.0
    return sign * number_value(word.lstrip("+-"))


def parse_literals(text: str) -> list[Any]:
    """Return the value of an aggregate of literals: lists of lists, numbers, strings and truth values.

    The value is shared between calls and is not to be changed.
    """
    return _parsed(text)
