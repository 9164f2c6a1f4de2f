"""All children in turn, until one succeeds."""

from collections.abc import Iterator
from typing import Any

from py_trees.common import Status

from daidalos.navigation.trees.node import Control


class Fallback(Control):
    """Ticks one child after the other, going on with the one that runs; succeeds with the first that does."""

    reactive = False

    def tick(self) -> Iterator[Any]:
        """Tick children until one does not fail."""
        if self.status != Status.RUNNING:
            self.current_child = None
        first = self.children.index(self.current_child) if self.current_child and not self.reactive else 0
        for child in self.children[first:]:
            yield from child.tick()
            if child.status != Status.FAILURE:
                self.current_child = child
                self.conclude(child.status, runs=child)
                yield self
                return
        self.conclude(Status.FAILURE)
        yield self


class ReactiveFallback(Fallback):
    """Begins with the first child at every tick; halts a running child when one before it does not fail."""

    reactive = True
