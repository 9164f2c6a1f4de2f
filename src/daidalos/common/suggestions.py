"""Known names near an unknown one."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from difflib import SequenceMatcher

MIN_LIKENESS = 0.7
LEAF_WEIGHT = 0.7
"""Weight of the last part of a name; what stands before it is often shared by names that mean different things."""

MAX_LISTED = 12
"""Number of known names up to which all are listed where none is near."""


def near(name: str, known: Iterable[str]) -> list[str]:
    """Return at most three of the known names that are like a name, the nearest first."""
    may_be_like = _filter(name)
    likeness = {other: _likeness(name, other) for other in known if other != name and may_be_like(other)}
    found = [other for other in likeness if likeness[other] >= MIN_LIKENESS]
    return sorted(found, key=lambda other: (-likeness[other], other))[:3]


def hint(name: str, known: Iterable[str]) -> str:
    """Return the end of a message about an unknown name: the nearest known names, or all where they are few."""
    names = sorted(set(known))
    found = near(name, names)
    if found:
        return f"; did you mean {' or '.join(repr(one) for one in found)}?"
    return f"; there are: {', '.join(names) or 'none'}" if len(names) <= MAX_LISTED else ""


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """Return a line, with the line break before it, that suggests near names; empty where there are none."""
    names = near(name, known)
    return f"\nDid you mean {' or '.join(repr(one) for one in names)}?" if names else ""


def near_or_all(name: str, known: Iterable[str], kind: str) -> str:
    """Return a whole line with the near names, with all names where they are few, or that there are none.

    Parameters
    ----------
    name
        The unknown name.
    known
        The known ones.
    kind
        What they are, in the plural, such as ``actions``.
    """
    names = sorted(set(known) - {name})
    if near(name, names):
        return hint_line(name, names)
    if len(names) > MAX_LISTED:
        return f"There is no '{name}' among {len(names)} {kind}\n"
    return f"There are these {kind}: {', '.join(names)}\n" if names else f"There are no {kind}\n"


def hint_line(name: str, known: Iterable[str]) -> str:
    """Return a whole line that suggests near names; empty where there are none."""
    text = did_you_mean(name, known).removeprefix("\n")
    return f"{text}\n" if text else ""


def _filter(name: str) -> Callable[[str], bool]:
    """Return a predicate that rejects most of what is not like a name, by upper bounds of `_likeness`."""
    whole, leaf = SequenceMatcher(None, b=name), SequenceMatcher(None, b=_leaf(name))

    def may_be_like(other: str) -> bool:
        whole.set_seq1(other)
        leaf.set_seq1(_leaf(other))
        return (
            _weighted(leaf.real_quick_ratio(), whole.real_quick_ratio()) >= MIN_LIKENESS
            and _weighted(leaf.quick_ratio(), whole.quick_ratio()) >= MIN_LIKENESS
        )

    return may_be_like


def _likeness(one: str, other: str) -> float:
    leaf = SequenceMatcher(None, _leaf(one), _leaf(other)).ratio()
    return _weighted(leaf, SequenceMatcher(None, one, other).ratio())


def _weighted(leaf: float, whole: float) -> float:
    return LEAF_WEIGHT * leaf + (1.0 - LEAF_WEIGHT) * whole


def _leaf(name: str) -> str:
    return re.split(r"/|::", name)[-1].lower()
