"""Arguments with their variables filled in."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Mapping

from daidalos.workspaces.cmake.syntax import Argument

_REFERENCE = re.compile(r"\$(?P<where>ENV|CACHE)?\{(?P<name>[^${}]*)\}")
_ESCAPE = re.compile(r"\\(.)", re.DOTALL)
_ESCAPES = {"n": "\n", "t": "\t", "r": "\r"}


def expand(arguments: Iterable[Argument], variables: Mapping[str, str]) -> list[str]:
    """Return the values that a command sees: variables filled in, bare lists split into their items."""
    values: list[str] = []
    for argument in arguments:
        if argument.kind == "bracket":
            values.append(argument.text)
            continue
        text = _unescape(substitute(argument.text, variables))
        if argument.kind == "quoted":
            values.append(text)
        else:
            values += split(text)
    return values


def substitute(text: str, variables: Mapping[str, str]) -> str:
    """Fill in ``${NAME}`` and ``$ENV{NAME}``, the innermost first; what is not set is empty."""

    def value(match: re.Match[str]) -> str:
        name = match["name"]
        return os.environ.get(name, "") if match["where"] == "ENV" else variables.get(name, "")

    while True:
        text, count = _REFERENCE.subn(value, text)
        if not count:
            return text


def split(text: str) -> list[str]:
    """Return the items of a list."""
    return [item for item in text.split(";") if item]


def _unescape(text: str) -> str:
    return _ESCAPE.sub(lambda match: _ESCAPES.get(match[1], match[1]), text)
