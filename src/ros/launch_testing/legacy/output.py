"""Tests of output for `LaunchTestService`."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable
from typing import Any

from ..tools.output import get_default_filtered_patterns as get_default_filtered_patterns
from ..tools.output import get_default_filtered_prefixes as get_default_filtered_prefixes

OutputTest = tuple[Callable[[bytes], bool], str]


def get_rmw_output_filter(rmw_implementation: str, filter_type: str) -> list[str]:
    """Return what tests do not care about in the output of one middleware.

    It is listed in the resource `rmw_output_<filter_type>` of that middleware's package.
    """
    from ament_index_python import get_resource, has_resource

    resource = f"rmw_output_{filter_type}"
    if not has_resource(resource, rmw_implementation):
        return []
    content, _ = get_resource(resource, rmw_implementation)
    return content.splitlines()


def output_filters(
    filtered_prefixes: Iterable[str] | None,
    filtered_patterns: Iterable[str] | None,
    filtered_rmw_implementation: str | None,
) -> tuple[list[str], list[str]]:
    """Return the prefixes and the patterns of lines to take out; see `create_output_lines_filter`."""
    prefixes = list(get_default_filtered_prefixes() if filtered_prefixes is None else filtered_prefixes)
    patterns = list(get_default_filtered_patterns() if filtered_patterns is None else filtered_patterns)
    if filtered_rmw_implementation:
        prefixes += get_rmw_output_filter(filtered_rmw_implementation, "prefixes")
        patterns += get_rmw_output_filter(filtered_rmw_implementation, "patterns")
    return prefixes, patterns


def create_output_lines_filter(
    filtered_prefixes: Iterable[str] | None = None,
    filtered_patterns: Iterable[str] | None = None,
    filtered_rmw_implementation: str | None = None,
) -> Callable[[bytes], bytes]:
    """Return a function that takes lines out of output.

    Parameters
    ----------
    filtered_prefixes
        How the lines begin; the default ones if not said.
    filtered_patterns
        Regular expressions for the lines; the default ones if not said.
    filtered_rmw_implementation
        A middleware whose own output is taken out, too.
    """
    prefixes, patterns = output_filters(filtered_prefixes, filtered_patterns, filtered_rmw_implementation)
    encoded = tuple(prefix.encode() for prefix in prefixes)
    compiled = [re.compile(pattern.encode()) for pattern in patterns]

    def output_filter(output: bytes) -> bytes:
        kept = [
            line
            for line in output.splitlines()
            if line and not line.startswith(encoded) and not any(pattern.match(line) for pattern in compiled)
        ]
        return b"\n".join(kept) + (b"\n" if kept else b"")

    return output_filter


def create_output_lines_test(expected_lines: Iterable[str]) -> OutputTest:
    """Return a test that all lines came, in any order."""
    expected = [line.encode() for line in expected_lines]

    def test(output: bytes) -> bool:
        lines = output.splitlines()
        return all(any(line in actual for actual in lines) for line in expected)

    return test, "output_lines"


def create_output_regex_test(expected_patterns: Iterable[Any]) -> OutputTest:
    """Return a test that something came for each regular expression."""
    compiled = [
        re.compile(pattern if isinstance(pattern, bytes) else pattern.encode()) for pattern in expected_patterns
    ]

    def test(output: bytes) -> bool:
        return all(pattern.search(output) for pattern in compiled)

    return test, "output_regex"


def create_output_test_from_file(output_file: str) -> OutputTest:
    """Return a test of what a file lists: lines in `<output_file>.txt`, or expressions in `<output_file>.regex`.

    Raises
    ------
    RuntimeError
        If there is no such file.
    """
    literal, patterns = f"{output_file}.txt", f"{output_file}.regex"
    if os.path.isfile(literal):
        with open(literal, encoding="utf-8") as file:
            return create_output_lines_test(file.read().splitlines())
    if os.path.isfile(patterns):
        with open(patterns, encoding="utf-8") as file:
            return create_output_regex_test(file.read().splitlines())
    raise RuntimeError(f"could not find the expected output: neither {literal} nor {patterns} is there")
