"""Common base of sequence and fallback."""

from collections.abc import Iterator
from typing import Any, ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.node import Control


class InTurn(Control):
    """Control node that ticks children in order, resuming the running one.

    A child that is skipped (`INVALID` after its tick) is passed over; the node is skipped if all are.

    Attributes
    ----------
    goes_on_after : Status
        Class attribute: how a child has to end for the next one to have its turn; the node ends so after the last
        one, and otherwise as the child did.
    reactive : bool
        Class attribute: begin with the first child at every tick.
    pauses : bool
        Class attribute: run on to the next tick before each child but the first.
    remembers : bool
        Class attribute: begin with the child that ended the last run with another status.
    """

    goes_on_after: ClassVar[Status]
    reactive: ClassVar[bool] = False
    pauses: ClassVar[bool] = False
    remembers: ClassVar[bool] = False

    def tick(self) -> Iterator[Any]:
        """Tick children until one ends with another status."""
        is_remembered = self.remembers and self.status not in (Status.INVALID, self.goes_on_after)
        if self.status != Status.RUNNING and not is_remembered:
            self.current_child = None
        first = self.children.index(self.current_child) if self.current_child and not self.reactive else 0
        for child in self.children[first:]:
            yield from child.tick()
            if child.status not in (self.goes_on_after, Status.INVALID):
                status = child.status
                self.conclude(status, runs=child)
                self.current_child = child
                yield self
                return
            if self.pauses and child is not self.children[-1]:
                self.current_child = self.children[self.children.index(child) + 1]
                self.conclude(Status.RUNNING)
                yield self
                return
        was_skipped = all(child.status == Status.INVALID for child in self.children)
        self.conclude(Status.INVALID if was_skipped else self.goes_on_after)
        yield self
