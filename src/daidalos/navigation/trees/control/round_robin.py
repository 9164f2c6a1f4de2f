"""Round robin of children."""

from collections.abc import Iterator
from typing import Any

from py_trees.common import Status

from daidalos.navigation.trees.node import Control, Ports, TreeContext


class RoundRobin(Control):
    """Control node that starts with the child after the last success, and fails if all children fail.

    Only a halt while a child runs makes it begin with the first child again.
    """

    names = ("RoundRobin",)

    def __init__(self, ports: Ports, context: TreeContext) -> None:
        super().__init__(ports, context)
        self._turn = 0
        self._failed = 0

    def tick(self) -> Iterator[Any]:
        """Tick children until one does not fail."""
        if self.status != Status.RUNNING:
            self._failed = 0
        while self._failed < len(self.children):
            child = self.children[self._turn]
            self.current_child = child
            yield from child.tick()
            if child.status == Status.RUNNING:
                self.conclude(Status.RUNNING)
                yield self
                return
            self._turn = (self._turn + 1) % len(self.children)
            if child.status == Status.SUCCESS:
                self.conclude(Status.SUCCESS)
                yield self
                return
            self._failed += 1
        self.conclude(Status.FAILURE)
        yield self

    def stop(self, new_status: Status = Status.INVALID) -> None:
        """Reset if a child was interrupted."""
        if new_status == Status.INVALID and self.status == Status.RUNNING:
            self._turn = 0
        super().stop(new_status)
