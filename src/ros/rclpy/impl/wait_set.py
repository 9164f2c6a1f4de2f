"""Wait sets, and waitables written for them.

An executor here waits for no set: everything that becomes ready notifies it. A waitable as ROS 2's programs write them
is asked for its entities (`Waitable.add_to_wait_set`), and made ready when one of them is.
"""

from __future__ import annotations

import threading
import time
import weakref
from collections.abc import Callable
from typing import Any

from rclpy.impl.entities import GuardConditionHandle, QueueHandle
from rclpy.impl.ready import ReadyHook
from rclpy.impl.timer import TimerHandle

_KINDS = ("subscription", "guard_condition", "timer", "client", "service", "event")


class WaitSet:
    """Handles of entities, of which one or more are waited for.

    Parameters
    ----------
    *sizes
        How many of each kind, and the context; a set grows as it needs to, and so they are not looked at.
    """

    def __init__(self, *sizes: Any) -> None:
        self._entities: dict[str, list[Any]] = {kind: [] for kind in _KINDS}
        self._ready: dict[str, list[bool]] = {kind: [] for kind in _KINDS}

    def _add(self, kind: str, entity: Any) -> int:
        self._entities[kind].append(entity)
        self._ready[kind].append(False)
        return len(self._entities[kind]) - 1

    def add_subscription(self, subscription: Any) -> int:
        """Add a subscription, and return its index."""
        return self._add("subscription", subscription)

    def add_guard_condition(self, guard_condition: Any) -> int:
        """Add a guard condition, and return its index."""
        return self._add("guard_condition", guard_condition)

    def add_timer(self, timer: Any) -> int:
        """Add a timer, and return its index."""
        return self._add("timer", timer)

    def add_client(self, client: Any) -> int:
        """Add a client, and return its index."""
        return self._add("client", client)

    def add_service(self, service: Any) -> int:
        """Add a service, and return its index."""
        return self._add("service", service)

    def add_event(self, event: Any) -> int:
        """Add an event, and return its index."""
        return self._add("event", event)

    def clear_entities(self) -> None:
        """Remove all entities."""
        for kind in _KINDS:
            self._entities[kind].clear()
            self._ready[kind].clear()

    def is_ready(self, kind: str, index: int) -> bool:
        """Return whether an entity was ready at the end of the last `wait`."""
        if kind not in _KINDS:
            raise RuntimeError(f"'{kind}' is not a known entity; expected one of {', '.join(_KINDS)}")
        return self._ready[kind][index]

    def get_ready_entities(self, kind: str) -> list[int]:
        """Return the `pointer` of every entity of a kind that was ready at the end of the last `wait`."""
        pairs = zip(self._entities[kind], self._ready[kind], strict=True)
        return [entity.pointer for entity, ready in pairs if ready]

    def entities(self) -> list[Any]:
        """Return every entity."""
        return [entity for kind in _KINDS for entity in self._entities[kind]]

    def look(self) -> bool:
        """Check which entities are ready; return whether any is. A guard condition is ready once for each trigger."""
        for kind in _KINDS:
            self._ready[kind] = [_is_ready(entity) for entity in self._entities[kind]]
        return any(any(flags) for flags in self._ready.values())

    def wait(self, timeout_ns: int) -> None:
        """Wait until an entity is ready, for at most `timeout_ns` nanoseconds (negative: however long it takes)."""
        deadline = None if timeout_ns < 0 else time.monotonic_ns() + timeout_ns
        changed = threading.Event()
        stops = [_listen(entity, changed.set) for entity in self.entities()]
        try:
            while not self.look():
                now = time.monotonic_ns()
                if deadline is not None and now >= deadline:
                    return
                changed.wait(self._timeout(deadline, now))
                changed.clear()
        finally:
            for stop in stops:
                stop()

    def _timeout(self, deadline: int | None, now: int) -> float | None:
        """Return for how many seconds nothing but a signal of an entity can end the wait."""
        spans = [] if deadline is None else [deadline - now]
        for timer in self._entities["timer"]:
            left = timer.time_until_next_call()
            if left is not None and not timer.clock.overridden:
                spans.append(left)
        return max(min(spans), 0) / 1e9 if spans else None


def _is_ready(entity: Any) -> bool:
    if isinstance(entity, QueueHandle):
        return len(entity.impl) > 0
    if isinstance(entity, TimerHandle):
        return entity.is_timer_ready()
    if isinstance(entity, GuardConditionHandle):
        return entity.take_trigger()
    return bool(entity.is_ready)


def _listen(entity: Any, listener: Callable[[], None]) -> Callable[[], None]:
    """Call `listener` when an entity may have become ready; the result ends that."""
    stop: Callable[[], None] = entity.listen(listener)
    return stop


def adapt(waitable: Any) -> None:
    """Adapt a waitable written for wait sets to one that its entities make ready."""
    waitable._rcl_adapter = _Adapter(waitable)
    waitable._rcl_hook = waitable._rcl_adapter.hook
    waitable._rcl_take = waitable._rcl_adapter.take
    waitable._rcl_has_more = lambda: False


class _Adapter:
    """Adapter between an executor and a waitable written for wait sets."""

    def __init__(self, waitable: Any) -> None:
        self._waitable = weakref.ref(waitable)
        self.hook = ReadyHook(waitable)
        self._stops: dict[Any, Callable[[], None]] = {}
        self._timers: list[TimerHandle] = []
        self._schedule: Any = None
        self._ask(waitable)
        self.hook()  # something may be ready already

    def _ask(self, waitable: Any) -> WaitSet:
        """Request the waitable's entities, and listen to those that are new."""
        wait_set = WaitSet()
        waitable.add_to_wait_set(wait_set)
        entities = wait_set.entities()
        for gone in set(self._stops) - set(entities):
            self._stops.pop(gone)()
        for entity in entities:
            if entity not in self._stops:
                self._stops[entity] = _listen(entity, self.hook)
        self._timers = [entity for entity in entities if isinstance(entity, TimerHandle)]
        for timer in self._timers:
            timer.attach(self._schedule)
        return wait_set

    def attach(self, schedule: Any) -> None:
        """Set the executor that waits for wall time on behalf of the waitable's timers."""
        self._schedule = schedule
        for timer in self._timers:
            timer.attach(schedule)

    def take(self) -> tuple[Callable[..., Any], tuple[Any, ...]] | None:
        """Return what to call, None when the waitable is not ready."""
        waitable = self._waitable()
        if waitable is None:
            return None
        wait_set = self._ask(waitable)
        wait_set.look()
        if not waitable.is_ready(wait_set):
            return None
        data = waitable.take_data()
        self.hook()  # there may be more
        return waitable.execute, (data,)
