"""Decorators of BehaviorTree.CPP that tick their child again."""

from collections.abc import Iterator
from typing import Any, ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.node import Decorator, Port, flag


class _Again(Decorator):
    """Decorator that ticks its child anew after one outcome, up to a number of times; -1 for no limit.

    Attributes
    ----------
    AFTER : Status
        Class attribute: the outcome after which the child is ticked anew.
    NUMBER : str
        Class attribute: the port with the number of times; empty for no limit.
    """

    AFTER: ClassVar[Status]
    NUMBER: ClassVar[str] = ""
    _count = 0

    def tick(self) -> Iterator[Any]:
        """Tick the child, at most once."""
        if self.status != Status.RUNNING:
            self._count = 0
        yield from self.decorated.tick()
        self.status = self.decorated.status
        if self.status == self.AFTER:
            self._count += 1
            limit = self.ports.get(self.NUMBER) if self.NUMBER else -1
            self.decorated.stop(Status.INVALID)
            if limit < 0 or self._count < limit:
                self.status = Status.RUNNING
        yield self


class RetryUntilSuccessful(_Again):
    """Decorator that ticks its child anew after a failure, `num_attempts` times in all."""

    names = ("RetryUntilSuccessful", "RetryUntilSuccesful")
    AFTER = Status.FAILURE
    NUMBER = "num_attempts"
    PORTS: ClassVar[dict[str, Port]] = {"num_attempts": Port(int)}


class Repeat(_Again):
    """Decorator that ticks its child anew after a success, `num_cycles` times in all."""

    names = ("Repeat",)
    AFTER = Status.SUCCESS
    NUMBER = "num_cycles"
    PORTS: ClassVar[dict[str, Port]] = {"num_cycles": Port(int)}


class RunOnce(Decorator):
    """Decorator that ticks its child until it has ended once; it is skipped afterwards, or returns the same status."""

    names = ("RunOnce",)
    PORTS: ClassVar[dict[str, Port]] = {"then_skip": Port(flag, True)}
    _ended: Status | None = None

    def tick(self) -> Iterator[Any]:
        """Tick the child until it has ended."""
        if self._ended is None:
            yield from self.decorated.tick()
            self.status = self.decorated.status
            self._ended = self.status if self.status in (Status.SUCCESS, Status.FAILURE) else None
        else:
            self.status = Status.INVALID if self.ports.get("then_skip") else self._ended
        yield self


class KeepRunningUntilFailure(_Again):
    """Decorator that ticks its child anew after each success."""

    names = ("KeepRunningUntilFailure",)
    AFTER = Status.SUCCESS
