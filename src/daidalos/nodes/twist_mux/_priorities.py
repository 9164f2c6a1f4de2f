"""Selection among sources by their priorities, ages and locks."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass
class Source:
    """Source of messages, and the time of its last message.

    Attributes
    ----------
    name, topic : str
        Of the source.
    timeout : float
        For how long a message counts [s]; 0 for ever.
    priority : int
        The higher, the sooner it counts; at least 0.
    received_at : float or None
        When the last message came [s].
    """

    name: str
    topic: str
    timeout: float
    priority: int
    received_at: float | None = None

    def is_silent(self, now: float) -> bool:
        """Return whether there is no recent message."""
        return self.received_at is None or 0 < self.timeout < now - self.received_at


@dataclass
class Lock(Source):
    """Source of True, which locks all sources up to its priority, and False; a timeout locks, too."""

    is_closed: bool = False

    def is_locked(self, now: float) -> bool:
        """Return whether the lock is closed."""
        return self.is_closed or (self.timeout > 0 and self.is_silent(now))


def lock_priority(locks: Iterable[Lock], now: float) -> int:
    """Return up to which priority sources are locked; 0 where nothing is."""
    return max((lock.priority for lock in locks if lock.is_locked(now)), default=0)


def active(sources: Iterable[Source], locks: Iterable[Lock], now: float) -> Source | None:
    """Return the source that counts, None where none does; the first of several with the same priority."""
    limit = lock_priority(locks, now)
    able = [source for source in sources if source.priority > limit and not source.is_silent(now)]
    return max(able, key=lambda source: source.priority, default=None)
