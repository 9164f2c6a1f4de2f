"""Decorators that limit or delay the run of their child."""

from collections.abc import Iterator
from typing import Any, ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.node import Decorator, Port


class Timeout(Decorator):
    """Decorator that halts its child and fails when the child has run for `msec` [ms]."""

    names = ("Timeout",)
    PORTS: ClassVar[dict[str, Port]] = {"msec": Port(int)}
    _since = 0.0

    def tick(self) -> Iterator[Any]:
        """Tick the child unless its time is over."""
        now = self.services.now()
        if self.status != Status.RUNNING:
            self._since = now
        limit = self.ports.get("msec")
        if self.status == Status.RUNNING and limit > 0 and now - self._since >= limit / 1000.0:
            self.decorated.stop(Status.INVALID)
            self.status = Status.FAILURE
        else:
            yield from self.decorated.tick()
            self.status = self.decorated.status
        yield self


class Delay(Decorator):
    """Decorator that ticks its child after a time `delay_msec` [ms]."""

    names = ("Delay",)
    PORTS: ClassVar[dict[str, Port]] = {"delay_msec": Port(int)}
    _since = 0.0

    def tick(self) -> Iterator[Any]:
        """Tick the child once the time is over, and while it runs."""
        now = self.services.now()
        if self.status != Status.RUNNING:
            self._since = now
        is_due = now - self._since >= self.ports.get("delay_msec") / 1000.0
        if is_due or self.decorated.status == Status.RUNNING:
            yield from self.decorated.tick()
            self.status = self.decorated.status
        else:
            self.status = Status.RUNNING
        yield self
