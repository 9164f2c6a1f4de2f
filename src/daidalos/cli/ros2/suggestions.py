"""Names near the one that was given."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


def near(name: str, known: Iterable[str]) -> list[str]:
    """Return at most three of the known names that are like a name, the nearest first."""
    return difflib.get_close_matches(name, list(known), n=3)


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """Return a line, with the line break before it, that suggests near names; empty where there are none."""
    names = near(name, known)
    return f"\nDid you mean {' or '.join(repr(one) for one in names)}?" if names else ""
