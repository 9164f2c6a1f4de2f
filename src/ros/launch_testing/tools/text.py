"""Comparison of text with what was expected."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from typing import Any

Match = Callable[..., tuple[int, int] | None]


def normalize_lineseps(lines: str | Iterable[str]) -> Any:
    """Return a text, or lines, that end as they do on this kind of system in memory: with a newline only."""
    if isinstance(lines, str):
        return lines.replace("\r\n", "\n")
    return [line.replace("\r\n", "\n") for line in lines]


def build_text_match(expected_text: Any, *, strict: bool = False) -> Match:
    """Return a function that finds what is expected in a text.

    The function takes the text and where to begin, and returns the place, begin and end, or None.

    Parameters
    ----------
    expected_text
        A text, a regular expression, or several of these that follow one another.
    strict
        Whether the text must be it, begin with what the expression matches, or begin with the first of several and
        have nothing between two of them.
    """
    if isinstance(expected_text, str):
        expected = normalize_lineseps(expected_text)

        def find_text(actual: str, start: int = 0) -> tuple[int, int] | None:
            actual = normalize_lineseps(actual)
            if strict:
                return (start, len(actual)) if actual[start:] == expected else None
            place = actual.find(expected, start)
            return None if place < 0 else (place, place + len(expected))

        return find_text
    if hasattr(expected_text, "search"):
        return _build_pattern_match(expected_text, strict=strict)
    return _build_sequence_match(list(expected_text), strict=strict)


def _build_pattern_match(pattern: re.Pattern[str], *, strict: bool) -> Match:
    def find_pattern(actual: str, start: int = 0) -> tuple[int, int] | None:
        actual = normalize_lineseps(actual)
        match = pattern.match(actual, start) if strict else pattern.search(actual, start)
        return None if match is None else match.span()

    return find_pattern


def _build_sequence_match(items: list[Any], *, strict: bool) -> Match:
    matches = [build_text_match(item) for item in items]
    return _chained(matches, strict=strict)


def _chained(matches: list[Match], *, strict: bool) -> Match:
    """Return a function that finds what follows one another; strictly, with nothing before it or between two."""

    def find_sequence(actual: Any, start: int = 0) -> tuple[int, int] | None:
        begin: int | None = None
        end = start
        for match in matches:
            place = match(actual, end)
            if place is None or (strict and place[0] != end):
                return None
            begin = place[0] if begin is None else begin
            end = place[1]
        return (start if begin is None else begin), end

    return find_sequence


def build_line_match(expected_lines: Any, *, strict: bool = False) -> Match:
    """Return a function that finds what is expected among lines.

    The function takes the lines and where to begin, and returns the place, begin and end, or None.

    Parameters
    ----------
    expected_lines
        A text or a regular expression for one line, or several of these, or of such several, for lines one after
        another.
    strict
        Whether no other lines may stand before them or between two; of one alone, whether every line must be it.
        Of several in one of several, other lines may stand between.
    """
    if isinstance(expected_lines, str) or hasattr(expected_lines, "match"):
        return _build_each_line_match(expected_lines) if strict else _build_line_search(expected_lines)
    return _build_lines_match(list(expected_lines), strict=strict)


def _build_each_line_match(expected: str | re.Pattern[str]) -> Match:
    is_expected = expected.__eq__ if isinstance(expected, str) else expected.match

    def find_lines(actual: Iterable[str], start: int = 0) -> tuple[int, int] | None:
        lines = normalize_lineseps(list(actual))
        return (start, len(lines)) if all(map(is_expected, lines[start:])) else None

    return find_lines


def _build_line_search(expected: str | re.Pattern[str]) -> Match:
    """Find the next line that has a text in it, or that a regular expression matches from its beginning."""
    is_found = (lambda line: expected in line) if isinstance(expected, str) else expected.match

    def find_line(actual: Iterable[str], start: int = 0) -> tuple[int, int] | None:
        lines = normalize_lineseps(list(actual))
        return next(((i, i + 1) for i in range(start, len(lines)) if is_found(lines[i])), None)

    return find_line


def _build_lines_match(items: list[Any], *, strict: bool) -> Match:
    return _chained([build_line_match(item) for item in items], strict=strict)
