"""Filters of output that also know what middlewares print."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from launch_testing.legacy.output import get_rmw_output_filter as get_rmw_output_filter
from launch_testing.tools import basic_output_filter as _basic_output_filter
from launch_testing.tools.output import get_default_filtered_patterns, get_default_filtered_prefixes


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
    prefixes = list(get_default_filtered_prefixes() if filtered_prefixes is None else filtered_prefixes)
    patterns = list(get_default_filtered_patterns() if filtered_patterns is None else filtered_patterns)
    if filtered_rmw_implementation:
        prefixes += get_rmw_output_filter(filtered_rmw_implementation, "prefixes")
        patterns += get_rmw_output_filter(filtered_rmw_implementation, "patterns")
    return _basic_output_filter(prefixes, patterns)
