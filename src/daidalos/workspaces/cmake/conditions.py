"""Conditions of if() and while()."""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Protocol

from daidalos.workspaces.cmake.syntax import Argument
from daidalos.workspaces.cmake.values import expand, split

_FALSE = {"", "0", "OFF", "NO", "FALSE", "N", "IGNORE", "NOTFOUND"}
_TRUE = {"1", "ON", "YES", "TRUE", "Y"}
_COMPARISONS: dict[str, Callable[[Any, Any], bool]] = {
    "LESS": operator.lt,
    "GREATER": operator.gt,
    "EQUAL": operator.eq,
    "LESS_EQUAL": operator.le,
    "GREATER_EQUAL": operator.ge,
}


class Scope(Protocol):
    """Names that conditions refer to."""

    @property
    def variables(self) -> Mapping[str, str]:
        """Variables that are set."""

    @property
    def folder(self) -> Path:
        """Base folder of relative paths."""

    def is_command(self, name: str) -> bool:
        """Return whether there is a command of this name."""

    def is_target(self, name: str) -> bool:
        """Return whether there is a target of this name."""


def is_true(arguments: tuple[Argument, ...], scope: Scope) -> bool:
    """Evaluate a condition.

    Raises
    ------
    ValueError
        When it has no meaning.
    """
    words = [
        (value, argument.kind == "bare")
        for argument in arguments
        for value in (expand([argument], scope.variables) if argument.kind != "bracket" else [argument.text])
    ]
    reader = _Reader(words, scope)
    result = reader.any()
    if reader.rest:
        raise ValueError(f"the condition has '{reader.rest[0][0]}' where AND or OR was expected")
    return result


class _Reader:
    """Parser of conditions; a word is its text and whether it is unquoted."""

    def __init__(self, words: list[tuple[str, bool]], scope: Scope) -> None:
        self.rest = words
        self._scope = scope

    def any(self) -> bool:
        """Parse tests joined by AND and OR, which have the same precedence."""
        result = self._not()
        while True:
            if self._skip("AND"):
                result = self._not() and result
            elif self._skip("OR"):
                result = self._not() or result
            else:
                return result

    def _not(self) -> bool:
        return not self._not() if self._skip("NOT") else self._test()

    def _test(self) -> bool:
        if self._skip("("):
            result = self.any()
            if not self._skip(")"):
                raise ValueError("the condition has a '(' without ')'")
            return result
        word, bare = self._next()
        unary = self._unary(word) if bare and self.rest and self.rest[0][0] not in ("AND", "OR", ")") else None
        if unary is not None:
            return unary
        if self.rest and self.rest[0][1] and _is_comparison(self.rest[0][0]):
            comparison = self._next()[0]
            return self._compare(word, bare, comparison, *self._next())
        return self._truth(word, bare)

    def _unary(self, word: str) -> bool | None:
        scope = self._scope
        tests: dict[str, Callable[[str], bool]] = {
            "EXISTS": lambda name: (scope.folder / name).exists(),
            "IS_DIRECTORY": lambda name: (scope.folder / name).is_dir(),
            "IS_SYMLINK": lambda name: (scope.folder / name).is_symlink(),
            "IS_ABSOLUTE": lambda name: Path(name).is_absolute(),
            "DEFINED": lambda name: name in scope.variables,
            "COMMAND": scope.is_command,
            "TARGET": scope.is_target,
            "POLICY": lambda name: True,
            "TEST": lambda name: False,
        }
        if word not in tests or _is_comparison(self.rest[0][0]):
            return None
        return tests[word](self._next()[0])

    def _compare(self, left: str, left_bare: bool, comparison: str, right: str, right_bare: bool) -> bool:
        if comparison == "IN_LIST":
            return self._value(left, left_bare) in split(self._scope.variables.get(right, ""))
        if comparison == "MATCHES":
            return re.search(right, self._value(left, left_bare)) is not None
        a, b = self._value(left, left_bare), self._value(right, right_bare)
        if comparison == "PATH_EQUAL":
            return Path(a) == Path(b)
        if comparison.startswith("STR"):
            return _COMPARISONS[comparison.removeprefix("STR")](a, b)
        if comparison.startswith("VERSION_"):
            return _COMPARISONS[comparison.removeprefix("VERSION_")](_version(a), _version(b))
        try:
            return _COMPARISONS[comparison](float(a), float(b))
        except ValueError:
            return False

    def _value(self, word: str, bare: bool) -> str:
        return self._scope.variables.get(word, word) if bare else word

    def _truth(self, word: str, bare: bool) -> bool:
        upper = word.upper()
        if upper in _TRUE or re.fullmatch(r"-?(?=.*[1-9])\d+(\.\d+)?", word):
            return True
        if upper in _FALSE or upper.endswith("-NOTFOUND") or not bare:
            return False
        value = self._scope.variables.get(word, "").upper()
        return value not in _FALSE and not value.endswith("-NOTFOUND")

    def _skip(self, word: str) -> bool:
        if self.rest and self.rest[0] == (word, True):
            self.rest = self.rest[1:]
            return True
        return False

    def _next(self) -> tuple[str, bool]:
        if not self.rest:
            raise ValueError("the condition ends too early")
        word, self.rest = self.rest[0], self.rest[1:]
        return word


def _is_comparison(word: str) -> bool:
    bare = word.removeprefix("VERSION_").removeprefix("STR")
    return bare in _COMPARISONS or word in ("MATCHES", "IN_LIST", "PATH_EQUAL")


def _version(text: str) -> tuple[int, ...]:
    numbers = [int(number) for number in re.findall(r"\d+", text)]
    while numbers and numbers[-1] == 0:
        numbers.pop()
    return tuple(numbers)
