"""Common base of sequence and fallback."""

from collections.abc import Iterator
from typing import Any, ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.node import Control


class InTurn(Control):
    """Control node that ticks children in order, resuming the running one.

    Attributes
    ----------
    goes_on_after : Status
        Class attribute: how a child has to end for the next one to have its turn; the node ends so after the last
        one, and otherwise as the child did.
    reactive : bool
        Class attribute: begin with the first child at every tick.
    """

    goes_on_after: ClassVar[Status]
    reactive: ClassVar[bool] = False

    def tick(self) -> Iterator[Any]:
        """Tick children until one ends with another status."""
        if self.status != Status.RUNNING:
            self.current_child = None
        first = self.children.index(self.current_child) if self.current_child and not self.reactive else 0
        for child in self.children[first:]:
            yield from child.tick()
            if child.status != self.goes_on_after:
                self.current_child = child
                self.conclude(child.status, runs=child)
                yield self
                return
        self.conclude(self.goes_on_after)
        yield self
