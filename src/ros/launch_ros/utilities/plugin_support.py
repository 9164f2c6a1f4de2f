"""Versions of extensions."""

from __future__ import annotations


class PluginException(Exception):
    """An extension cannot be used."""


def satisfies_version(version: str, caret_range: str) -> bool:
    """Return whether a version is in a range like `^1.2`: from that version to the next that may break things.

    Raises
    ------
    ValueError
        If the range does not begin with `^`.
    """
    if not caret_range.startswith("^"):
        raise ValueError(f"'{caret_range}' is not a caret range")
    lower = caret_range[1:]
    return _parts(lower) <= _parts(version) < _parts(get_upper_bound_caret_version(lower))


def get_upper_bound_caret_version(version: str) -> str:
    """Return the first version after this one that may break things: where the first number other than 0 grows."""
    parts = _parts(version)
    grows = next((place for place, part in enumerate(parts) if part), len(parts) - 1)
    return ".".join(str(part) for part in (*parts[:grows], parts[grows] + 1, *(0,) * (len(parts) - grows - 1)))


def _parts(version: str) -> tuple[int, ...]:
    return tuple(int(part) for part in version.split("."))
