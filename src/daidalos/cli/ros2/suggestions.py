"""Names near the one that was given."""

from __future__ import annotations

from collections.abc import Iterable

from daidalos.common.suggestions import near


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """Return a line, with the line break before it, that suggests near names; empty where there are none."""
    names = near(name, known)
    return f"\nDid you mean {' or '.join(repr(one) for one in names)}?" if names else ""


def hint_line(name: str, known: Iterable[str]) -> str:
    """Return a whole line that suggests near names; empty where there are none."""
    text = did_you_mean(name, known).removeprefix("\n")
    return f"{text}\n" if text else ""
