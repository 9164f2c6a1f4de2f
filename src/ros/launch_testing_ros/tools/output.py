"""Filters of output that also know what middlewares print."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from launch_testing.legacy.output import get_rmw_output_filter as get_rmw_output_filter
from launch_testing.legacy.output import output_filters
from launch_testing.tools import basic_output_filter as _basic_output_filter


def basic_output_filter(
    filtered_prefixes: Iterable[str] | None = None,
    filtered_patterns: Iterable[str] | None = None,
    filtered_rmw_implementation: str | None = None,
) -> Callable[[str], str]:
    """Return a function that takes lines out of a text.

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
    return _basic_output_filter(prefixes, patterns)
