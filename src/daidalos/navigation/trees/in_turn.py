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
    remembers : bool
        Class attribute: begin with the child that ended the last run with another status.
    """

    goes_on_after: ClassVar[Status]
    reactive: ClassVar[bool] = False
    remembers: ClassVar[bool] = False

    def tick(self) -> Iterator[Any]:
        """Tick children until one ends with another status."""
        is_remembered = self.remembers and self.status not in (Status.INVALID, self.goes_on_after)
        if self.status != Status.RUNNING and not is_remembered:
            self.current_child = None
        first = self.children.index(self.current_child) if self.current_child and not self.reactive else 0
        for child in self.children[first:]:
            yield from child.tick()
            if child.status != self.goes_on_after:
                status = child.status
                self.conclude(status, runs=child)
                self.current_child = child
                yield self
                return
        self.conclude(self.goes_on_after)
        yield self
