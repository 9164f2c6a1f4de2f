"""Sequence whose earlier children are ticked again while a later one runs."""

from collections.abc import Iterator
from typing import Any

from py_trees.common import Status

from daidalos.navigation.trees.node import Control


class PipelineSequence(Control):
    """Control node that ticks all children up to the farthest one reached.

    An earlier child that runs again does not hold up those after it; one that fails ends the pipeline.
    """

    names = ("PipelineSequence",)

    def tick(self) -> Iterator[Any]:
        """Tick all started children, and one more after each success."""
        if self.status != Status.RUNNING:
            self.current_child = self.children[0]
        reached = self.children.index(self.current_child)
        for index, child in enumerate(self.children):
            yield from child.tick()
            if child.status == Status.FAILURE:
                self.conclude(Status.FAILURE)
                yield self
                return
            if child.status == Status.RUNNING and index >= reached:
                self.current_child = child
                self.conclude(Status.RUNNING)
                yield self
                return
        was_skipped = all(child.status == Status.INVALID for child in self.children)
        self.conclude(Status.INVALID if was_skipped else Status.SUCCESS)
        yield self
