"""Notification of executors by entities that become ready."""

from __future__ import annotations

import weakref
from collections.abc import Callable
from typing import Any


class ReadyHook:
    """Calling it, from any thread, makes its entity ready.

    An entity stands in its executor's queue at most once; what becomes ready while no executor is attached is
    put into the queue when one is. An executor may find an entity with nothing to do: it then passes over it.

    Attributes
    ----------
    entity
        Returns the entity, None when it is no more: the transport, which holds the hook, must not keep it alive.
    """

    __slots__ = ("entity", "queued", "sink")

    def __init__(self, entity: Any) -> None:
        self.entity: Callable[[], Any] = weakref.ref(entity)
        self.queued = False
        self.sink: Callable[[ReadyHook], None] | None = None

    def __call__(self) -> None:
        """Mark the entity as ready."""
        if not self.queued:
            self.queued = True
            sink = self.sink
            if sink is not None:
                sink(self)

    def attach(self, sink: Callable[[ReadyHook], None]) -> None:
        """Attach the hook to an executor's queue."""
        self.sink = sink
        if self.queued:
            sink(self)

    def detach(self) -> None:
        """Detach the hook from its queue."""
        self.sink = None


def _nothing() -> None:
    """Do nothing; the default callback."""


class ReadyNotifier:
    """Base of what calls a function, and perhaps listeners beside it, when something becomes ready."""

    _first: Callable[[], None] = staticmethod(_nothing)
    _others: tuple[Callable[[], None], ...] = ()

    def announce_to(self, function: Callable[[], None]) -> None:
        """Call this function, instead of the one before."""
        self._first = function
        self._wire(self._combined())

    def listen(self, listener: Callable[[], None]) -> Callable[[], None]:
        """Call a listener as well; the result ends that."""
        self._others = (*self._others, listener)
        self._wire(self._combined())

        def stop() -> None:
            self._others = tuple(other for other in self._others if other is not listener)
            self._wire(self._combined())

        return stop

    def _combined(self) -> Callable[[], None]:
        first, others = self._first, self._others
        if not others:
            return first

        def call() -> None:
            first()
            for other in others:
                other()

        return call

    def _wire(self, call: Callable[[], None]) -> None:
        """Connect `call`, which is called when something becomes ready."""
        raise NotImplementedError


def weakly(method: Callable[..., Any]) -> Callable[..., None]:
    """Return a function that calls a bound method as long as its object lives."""
    bound: Any = method
    reference, function = weakref.ref(bound.__self__), bound.__func__  # faster to call than a `WeakMethod`

    def call(*arguments: Any) -> None:
        alive = reference()
        if alive is not None:
            function(alive, *arguments)

    return call
