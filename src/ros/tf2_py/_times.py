"""Times and durations in any of their forms, as nanoseconds."""

from __future__ import annotations

from typing import Any


def time_ns(time: Any) -> int:
    """Return a time, or a time message, in nanoseconds.

    Raises
    ------
    TypeError
        When it is neither.
    """
    found = _nanoseconds(time)
    if found is None:
        raise TypeError("time must have sec and nanosec, or nanoseconds.")
    return found


def duration_ns(duration: Any) -> int:
    """Return a duration, or a duration message, in nanoseconds.

    Raises
    ------
    TypeError
        When it is neither.
    """
    found = _nanoseconds(duration)
    if found is None:
        raise TypeError("duration must have sec and nanosec, or nanoseconds.")
    return found


def _nanoseconds(span: Any) -> int | None:
    try:
        nanoseconds: int = span.nanoseconds
    except AttributeError:
        if hasattr(span, "sec") and hasattr(span, "nanosec"):
            return int(span.sec) * 1_000_000_000 + int(span.nanosec)
        return None
    return nanoseconds
