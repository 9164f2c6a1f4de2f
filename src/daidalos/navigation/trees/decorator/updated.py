"""Decorators that tick their child when an entry of the blackboard was written."""

from collections.abc import Iterator
from typing import Any, ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.node import Decorator, Port


class SkipUnlessUpdated(Decorator):
    """Decorator that is skipped unless `entry` was written since its last tick; a child that runs is ticked."""

    names = ("SkipUnlessUpdated",)
    PORTS: ClassVar[dict[str, Port]] = {"entry": Port(str)}
    OTHERWISE: ClassVar[Status] = Status.INVALID
    _seen = 0

    def tick(self) -> Iterator[Any]:
        """Tick the child if it runs or the entry is new."""
        revision = self.ports.blackboard.revision(self.ports.name_of("entry"))
        if self.decorated.status == Status.RUNNING or revision != self._seen:
            self._seen = revision
            yield from self.decorated.tick()
            self.status = self.decorated.status
        else:
            self.status = self.OTHERWISE
        yield self


class WaitValueUpdate(SkipUnlessUpdated):
    """Decorator that runs until `entry` was written since its last tick, then ticks its child."""

    names = ("WaitValueUpdate",)
    OTHERWISE: ClassVar[Status] = Status.RUNNING
