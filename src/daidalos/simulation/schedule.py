"""Schedule of the components' updates, in integer nanoseconds without drift."""

from __future__ import annotations

import heapq
from collections.abc import Iterator
from dataclasses import dataclass

from daidalos.simulation.contracts import Component


@dataclass(eq=False)
class _Entry:
    component: Component
    order: int
    start_ns: int
    count: int = 0
    due_ns: int = 0


class Schedule:
    """Queue of components by their next update; ties are resolved by the order of insertion.

    A component with a period is due at its start plus 1, 2, 3 ... periods, each rounded by itself, so
    that 15 Hz stays 15 Hz. Without a period, or with one shorter than a step, it is due after every step.
    """

    def __init__(self) -> None:
        # With the time and the order in front, which are compared faster than entries would be.
        self._queue: list[tuple[int, int, _Entry]] = []
        self._order = 0

    def add(self, component: Component, now_ns: int) -> None:
        """Add a component."""
        entry = _Entry(component, self._order, now_ns)
        self._order += 1
        heapq.heappush(self._queue, _advanced(entry, now_ns))

    def remove(self, components: list[Component]) -> None:
        """Remove components."""
        gone = {id(component) for component in components}
        self._queue = [item for item in self._queue if id(item[2].component) not in gone]
        heapq.heapify(self._queue)

    def restart(self, now_ns: int) -> None:
        """Restart the clocks of all components."""
        for _, _, entry in self._queue:
            entry.start_ns, entry.count = now_ns, 0
        self._queue = [_advanced(entry, now_ns) for _, _, entry in self._queue]
        heapq.heapify(self._queue)

    def next_due(self) -> int | None:
        """Return the time of the next update; None without components."""
        return self._queue[0][0] if self._queue else None

    def due(self, now_ns: int) -> Iterator[Component]:
        """Yield each component that is due and set its next update."""
        while self._queue and self._queue[0][0] <= now_ns:
            entry = self._queue[0][2]
            heapq.heapreplace(self._queue, _advanced(entry, now_ns))
            yield entry.component

    def save(self) -> dict[int, tuple[int, int, int]]:
        """Return the clocks of the components, by identity."""
        return {id(e.component): (e.due_ns, e.start_ns, e.count) for _, _, e in self._queue}

    def restore(self, clocks: dict[int, tuple[int, int, int]]) -> None:
        """Restore the clocks of the components that `save` returned."""
        for _, _, entry in self._queue:
            if id(entry.component) in clocks:
                entry.due_ns, entry.start_ns, entry.count = clocks[id(entry.component)]
        self._queue = [(entry.due_ns, entry.order, entry) for _, _, entry in self._queue]
        heapq.heapify(self._queue)


def _advanced(entry: _Entry, now_ns: int) -> tuple[int, int, _Entry]:
    """Set the next time after `now_ns`, missed periods within a step merged; return the item of the queue."""
    period_ns = entry.component.period * 1e9
    if period_ns <= 1:
        entry.due_ns = now_ns + 1
    else:
        entry.count = max(entry.count, int((now_ns - entry.start_ns) / period_ns)) + 1
        entry.due_ns = entry.start_ns + round(entry.count * period_ns)
        if entry.due_ns <= now_ns:
            entry.count += 1
            entry.due_ns = entry.start_ns + round(entry.count * period_ns)
    return entry.due_ns, entry.order, entry
