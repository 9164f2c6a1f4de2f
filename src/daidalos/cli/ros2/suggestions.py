"""Names near the one that was given."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import SequenceMatcher

_MIN_LIKENESS = 0.7
_LEAF = 0.7
"""Weight of the last part of a name; what stands before it is often shared by names that mean different things."""


def near(name: str, known: Iterable[str]) -> list[str]:
    """Return at most three of the known names that are like a name, the nearest first."""
    likeness = {other: _likeness(name, other) for other in known if other != name}
    found = [other for other in likeness if likeness[other] >= _MIN_LIKENESS]
    return sorted(found, key=lambda other: (-likeness[other], other))[:3]


def _likeness(one: str, other: str) -> float:
    leaf = SequenceMatcher(None, _leaf(one), _leaf(other)).ratio()
    return _LEAF * leaf + (1.0 - _LEAF) * SequenceMatcher(None, one, other).ratio()


def _leaf(name: str) -> str:
    return name.rsplit("/", 1)[-1].lower()


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """Return a line, with the line break before it, that suggests near names; empty where there are none."""
    names = near(name, known)
    return f"\nDid you mean {' or '.join(repr(one) for one in names)}?" if names else ""


def hint_line(name: str, known: Iterable[str]) -> str:
    """Return a whole line that suggests near names; empty where there are none."""
    text = did_you_mean(name, known).removeprefix("\n")
    return f"{text}\n" if text else ""
