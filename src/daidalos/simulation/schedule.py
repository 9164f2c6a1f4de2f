"""Schedule of the components' updates, in integer nanoseconds without drift."""

from __future__ import annotations

import heapq
from collections.abc import Iterator
from dataclasses import dataclass

from daidalos.simulation.contracts import Component


@dataclass(order=True)
class _Entry:
    due_ns: int
    order: int
    start_ns: int
    count: int
    period: float
    component: Component


class Schedule:
    """Queue of components by their next update; ties are resolved by the order of insertion.

    A component with a period is due at its start plus 1, 2, 3 ... periods, each rounded by itself, so
    that 15 Hz stays 15 Hz. Without a period, or with one shorter than a step, it is due after every step.
    """

    def __init__(self) -> None:
        self._entries: list[_Entry] = []
        self._order = 0

    def add(self, component: Component, now_ns: int) -> None:
        """Add a component."""
        entry = _Entry(0, self._order, now_ns, 0, component.period, component)
        self._order += 1
        _advance(entry, now_ns)
        heapq.heappush(self._entries, entry)

    def remove(self, components: list[Component]) -> None:
        """Remove components."""
        gone = {id(component) for component in components}
        self._entries = [entry for entry in self._entries if id(entry.component) not in gone]
        heapq.heapify(self._entries)

    def restart(self, now_ns: int) -> None:
        """Restart the clocks of all components."""
        for entry in self._entries:
            entry.start_ns, entry.count = now_ns, 0
            _advance(entry, now_ns)
        heapq.heapify(self._entries)

    def next_due(self) -> int | None:
        """Return the time of the next update; None without components."""
        return self._entries[0].due_ns if self._entries else None

    def due(self, now_ns: int) -> Iterator[Component]:
        """Yield each component that is due and set its next update."""
        while self._entries and self._entries[0].due_ns <= now_ns:
            entry = self._entries[0]
            _advance(entry, now_ns)
            heapq.heapreplace(self._entries, entry)
            yield entry.component

    def save(self) -> dict[int, tuple[int, int, int]]:
        """Return the clocks of the components, by identity."""
        return {id(e.component): (e.due_ns, e.start_ns, e.count) for e in self._entries}

    def restore(self, clocks: dict[int, tuple[int, int, int]]) -> None:
        """Restore the clocks of the components that `save` returned."""
        for entry in self._entries:
            if id(entry.component) in clocks:
                entry.due_ns, entry.start_ns, entry.count = clocks[id(entry.component)]
        heapq.heapify(self._entries)


def _advance(entry: _Entry, now_ns: int) -> None:
    """Set the next time after `now_ns`; missed periods within a step are merged."""
    period_ns = entry.period * 1e9
    if period_ns <= 1:
        entry.due_ns = now_ns + 1
        return
    entry.count = max(entry.count, int((now_ns - entry.start_ns) / period_ns)) + 1
    entry.due_ns = entry.start_ns + round(entry.count * period_ns)
    if entry.due_ns <= now_ns:
        entry.count += 1
        entry.due_ns = entry.start_ns + round(entry.count * period_ns)
