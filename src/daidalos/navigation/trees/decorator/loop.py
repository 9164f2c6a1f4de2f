"""Decorators that tick their child for each value of a queue."""

from collections.abc import Callable, Iterator
from typing import Any, ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.errors import TreeError
from daidalos.navigation.trees.node import Decorator, Port, Ports, TreeContext, entry, flag

_IF_EMPTY = {"SUCCESS": Status.SUCCESS, "FAILURE": Status.FAILURE, "SKIPPED": Status.INVALID}


def _ports(kind: Callable[[str], Any]) -> dict[str, Port]:
    def queue(text: str) -> list[Any]:
        return [kind(part.strip()) for part in text.split(";") if part.strip()]

    return {"queue": Port(queue), "if_empty": Port(str, "SUCCESS"), "value": Port(entry, output=True)}


class LoopString(Decorator):
    """Decorator that takes the values of `queue` one by one, outputs each as `value`, and ticks its child.

    It fails with its child, and returns `if_empty` when there is no value left. Values of a literal come again at the
    next run; those of the blackboard are taken out of the list there.
    """

    names = ("LoopString",)
    PORTS: ClassVar[dict[str, Port]] = _ports(str)

    def __init__(self, ports: Ports, context: TreeContext) -> None:
        super().__init__(ports, context)
        if ports.get("if_empty") not in _IF_EMPTY:
            raise TreeError(
                f"{ports.where}: if_empty must be one of {', '.join(_IF_EMPTY)}, not {ports.get('if_empty')!r}"
            )
        self._queue: list[Any] = []

    def tick(self) -> Iterator[Any]:
        """Take the next value unless the child runs, and tick the child."""
        if self.status != Status.RUNNING:
            queue = self.ports.get("queue")
            self._queue = queue if self.ports.is_bound("queue") and isinstance(queue, list) else list(queue or ())
        if self.decorated.status != Status.RUNNING:
            if not self._queue:
                self.status = _IF_EMPTY[self.ports.get("if_empty")]
                yield self
                return
            self.ports.set("value", self._queue.pop(0))
        yield from self.decorated.tick()
        self.status = Status.FAILURE if self.decorated.status == Status.FAILURE else Status.RUNNING
        yield self


class LoopInt(LoopString):
    """Loop over whole numbers."""

    names = ("LoopInt",)
    PORTS: ClassVar[dict[str, Port]] = _ports(int)


class LoopDouble(LoopString):
    """Loop over numbers."""

    names = ("LoopDouble",)
    PORTS: ClassVar[dict[str, Port]] = _ports(float)


class LoopBool(LoopString):
    """Loop over Booleans."""

    names = ("LoopBool",)
    PORTS: ClassVar[dict[str, Port]] = _ports(flag)
