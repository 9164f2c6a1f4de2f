"""Filters of output and comparison with what was expected."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable
from typing import Any

from .text import build_line_match, build_text_match

_ANSI = re.compile(r"\x1b(?:\[[0-?]*[ -/]*[@-~]|[@-Z\\-_])")


def get_default_filtered_prefixes() -> list[str]:
    """Return how those lines begin that launch prints and that tests do not care about."""
    return ["pid", "rc"]


def get_default_filtered_patterns() -> list[str]:
    """Return regular expressions for lines that tests do not care about; there are none."""
    return []


def basic_output_filter(
    filtered_prefixes: Iterable[str] | None = None, filtered_patterns: Iterable[str] | None = None
) -> Callable[[str], str]:
    """Return a function that takes lines out of a text.

    Parameters
    ----------
    filtered_prefixes
        How the lines begin; the default ones if not said.
    filtered_patterns
        Regular expressions for the whole lines; the default ones if not said.
    """
    prefixes = tuple(get_default_filtered_prefixes() if filtered_prefixes is None else filtered_prefixes)
    patterns = [
        re.compile(pattern)
        for pattern in (get_default_filtered_patterns() if filtered_patterns is None else filtered_patterns)
    ]

    def keep(line: str) -> bool:
        return not line.startswith(prefixes) and not any(pattern.match(line.rstrip("\r\n")) for pattern in patterns)

    def output_filter(output: str) -> str:
        return "".join(line for line in output.splitlines(keepends=True) if keep(line))

    return output_filter


def expected_output_from_file(path: str, encoding: str | None = None) -> Any:
    """Return what a file says to expect: the lines of `<path>.txt`, or the patterns in `<path>.regex`.

    Raises
    ------
    RuntimeError
        If there is no such file.
    """
    literal, patterns = f"{path}.txt", f"{path}.regex"
    if os.path.isfile(literal):
        with open(literal, encoding=encoding) as file:
            return file.read().splitlines()
    if os.path.isfile(patterns):
        with open(patterns, encoding=encoding) as file:
            return [re.compile(line) for line in file.read().splitlines()]
    raise RuntimeError(f"could not find the expected output: neither {literal} nor {patterns} is there")


def expect_output(
    text: str | None = None,
    *,
    lines: list[str] | None = None,
    expected_text: Any = None,
    expected_lines: Any = None,
    strip_ansi_escape_sequences: bool = True,
    strict: bool = False,
) -> bool:
    """Return whether output is, or has in it, what is expected.

    Parameters
    ----------
    text, lines
        The output; one of the two.
    expected_text, expected_lines
        What is expected; one of the two, see `build_text_match` and `build_line_match`.
    strip_ansi_escape_sequences
        Whether colours are taken out of the output first.
    strict
        Whether the output must be it and nothing more.

    Raises
    ------
    ValueError
        If not exactly one of each two is given.
    """
    if (text is None) == (lines is None):
        raise ValueError("either 'text' or 'lines' must be given")
    if (expected_text is None) == (expected_lines is None):
        raise ValueError("either 'expected_text' or 'expected_lines' must be given")
    if expected_text is not None:
        actual = "\n".join(lines or []) if text is None else text
        actual = _ANSI.sub("", actual) if strip_ansi_escape_sequences else actual
        return build_text_match(expected_text, strict=strict)(actual) is not None
    actual_lines = (text or "").splitlines() if lines is None else lines
    if strip_ansi_escape_sequences:
        actual_lines = [_ANSI.sub("", line) for line in actual_lines]
    return build_line_match(expected_lines, strict=strict)(actual_lines) is not None
