"""The version of the interface between `ros2` and its extensions."""

from __future__ import annotations

import re

PLUGIN_SYSTEM_VERSION = "0.1"


def satisfies_version(version: str, caret_range: str) -> None:
    """Check that a version is in a caret range.

    Parameters
    ----------
    version
        What is there, such as ``0.1``.
    caret_range
        What an extension was made for: ``^0.1`` means at least 0.1, and the first number that is not zero unchanged.

    Raises
    ------
    ValueError
        When either cannot be read.
    RuntimeError
        When the version is not in the range.
    """
    if not caret_range.startswith("^"):
        raise ValueError(f"'{caret_range}' is not a caret range, such as '^0.1'")
    there, wanted = _numbers(version), _numbers(caret_range[1:])
    fixed = next((place for place, number in enumerate(wanted) if number), len(wanted) - 1) + 1
    if there < wanted or there[:fixed] != wanted[:fixed]:
        raise RuntimeError(f"Extension point version '{version}' does not satisfy '{caret_range}'")


def _numbers(version: str) -> tuple[int, ...]:
    if not re.fullmatch(r"\d+(\.\d+)*", version):
        raise ValueError(f"'{version}' is not a version, such as '0.1'")
    return tuple(map(int, version.split(".")))
