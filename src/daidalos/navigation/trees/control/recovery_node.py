"""Recovery node: retries its first child after its second one."""

from collections.abc import Iterator
from typing import Any, ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.node import Control, Port, Ports, TreeContext


class RecoveryNode(Control):
    """Control node that ticks its second child after a failure of its first one, and retries.

    Each time that the first child fails, the second must succeed before the next try. Fails when the second
    child fails or is skipped, or when the first has failed after all retries.
    """

    names = ("RecoveryNode",)
    PORTS: ClassVar[dict[str, Port]] = {"number_of_retries": Port(int, 1)}
    CHILDREN: ClassVar[tuple[int, int | None]] = (2, 2)

    def __init__(self, ports: Ports, context: TreeContext) -> None:
        super().__init__(ports, context)
        self._retries = 0

    def tick(self) -> Iterator[Any]:
        """Tick the current child, and switch to the other one when it ends at once."""
        main, recovery = self.children
        if self.status != Status.RUNNING:
            self._retries = 0
            self.current_child = main
        while True:
            child = self.current_child
            yield from child.tick()
            if child.status == Status.RUNNING:
                self.conclude(Status.RUNNING)
                break
            if child is recovery and child.status == Status.SUCCESS:
                self._retries += 1
                self.current_child = main
            elif (
                child is main and child.status == Status.FAILURE and self._retries < self.ports.get("number_of_retries")
            ):
                self.current_child = recovery
            else:
                was_skipped = child is recovery and child.status == Status.INVALID
                self.conclude(Status.FAILURE if was_skipped else child.status)
                break
        yield self
