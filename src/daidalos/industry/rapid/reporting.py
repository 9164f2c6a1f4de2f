"""Gathering of problems while modules are checked, and hints at near names."""

from __future__ import annotations

import functools
from collections.abc import Iterable

from daidalos.common.suggestions import near
from daidalos.industry.rapid.problems import Problem
from daidalos.industry.rapid.sources import Source

MAX_HINTS = 15
"""Unknown names of a module that near names are looked for."""

MAX_OTHER_LETTERS = 3
"""Letters that only one of two names may have for one to be a slip of the other."""


class Reporter:
    """Gathers the semantic problems of a module."""

    def __init__(self, source: Source) -> None:
        self.source = source
        self.problems: list[Problem] = []
        self._hints = 0

    def error(self, start: int, message: str, width: int = 1, runs: bool = False) -> None:
        """Report an error; with `runs`, one that does not keep the program from running."""
        line, column = self.source.place(start)
        self.problems.append(Problem(line, column, message, "semantic", column + width, False, runs))

    def warning(self, start: int, message: str, width: int = 1) -> None:
        """Report a warning."""
        line, column = self.source.place(start)
        self.problems.append(Problem(line, column, message, "semantic", column + width, True, True))

    def line(self, start: int) -> int:
        """Return the line of an offset."""
        return self.source.place(start)[0]

    def hint(self, text: str, known: Iterable[str]) -> str:
        """Return the end of a message about an unknown name: at most two names that are near it."""
        self._hints += 1
        if self._hints > MAX_HINTS:
            return ""
        found = nearest(text, known)
        return f"; did you mean {' or '.join(repr(one) for one in found)}?" if found else ""


def nearest(text: str, known: Iterable[str]) -> list[str]:
    """Return at most two known names that are near a name, wherever upper and lower case differ."""
    key, letters = _letters(text)
    slack = 2 + len(key) // 4
    spelled = {}
    for name in known:
        other, others = _letters(name)
        if (letters ^ others).bit_count() <= MAX_OTHER_LETTERS and -slack <= len(other) - len(key) <= slack:
            spelled[other] = name
    return [spelled[one] for one in near(key, spelled)][:2]


@functools.lru_cache(16384)
def _letters(name: str) -> tuple[str, int]:
    """Return a name in lower case, and the letters in it as bits."""
    key = name.lower()
    bits = 0
    for letter in key:
        bits |= 1 << (ord(letter) & 63)
    return key, bits
