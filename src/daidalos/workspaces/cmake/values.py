"""Expansion of variables in arguments."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Mapping

from daidalos.workspaces.cmake.syntax import Argument

_PIECE = re.compile(r"\\(?P<escaped>.)|\$(?P<where>ENV|CACHE)?\{|(?P<end>\})", re.DOTALL)
_ESCAPES = {"n": "\n", "t": "\t", "r": "\r", ";": "\\;"}


def expand(arguments: Iterable[Argument], variables: Mapping[str, str]) -> list[str]:
    """Return the values of an argument: variables expanded, unquoted lists split into their items."""
    values: list[str] = []
    for argument in arguments:
        if argument.kind == "bracket":
            values.append(argument.text)
        elif argument.kind == "quoted":
            values.append(substitute(argument.text, variables).replace("\\;", ";"))
        else:
            values += split(substitute(argument.text, variables))
    return values


def substitute(text: str, variables: Mapping[str, str]) -> str:
    """Expand ``${NAME}``, ``$ENV{NAME}`` (also nested) and backslashes; unset variables are empty."""
    return _Scanner(text, variables).run()


def split(text: str) -> list[str]:
    """Return the items of a list."""
    return [item.replace("\\;", ";") for item in re.split(r"(?<!\\);", text) if item]


class _Scanner:
    """Single-pass scanner of a text; expanded values are not scanned again."""

    def __init__(self, text: str, variables: Mapping[str, str]) -> None:
        self._text = text
        self._variables = variables
        self._position = 0

    def run(self, depth: int = 0) -> str:
        parts: list[str] = []
        while match := _PIECE.search(self._text, self._position):
            parts.append(self._text[self._position : match.start()])
            self._position = match.end()
            if match["escaped"]:
                parts.append(_ESCAPES.get(match["escaped"], match["escaped"]))
            elif not match["end"]:
                parts.append(self._value(match["where"], self.run(depth + 1)))
            elif depth:
                return "".join(parts)
            else:
                parts.append("}")
        parts.append(self._text[self._position :])
        self._position = len(self._text)
        return "".join(parts)

    def _value(self, where: str | None, name: str) -> str:
        return os.environ.get(name, "") if where == "ENV" else self._variables.get(name, "")
