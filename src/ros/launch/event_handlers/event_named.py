"""A question about the name of an event."""

from __future__ import annotations

from collections.abc import Callable

from ..event import Event


def event_named(name: str) -> Callable[[Event], bool]:
    """Return a function that returns whether an event has this name."""
    return lambda event: event.name == name
