"""Decorator with a script as its condition."""

from collections.abc import Iterator
from typing import Any, ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.errors import TreeError
from daidalos.navigation.trees.node import Decorator, Port, Ports, TreeContext
from daidalos.navigation.trees.scripts import Script

_ELSE = {
    "SUCCESS": Status.SUCCESS,
    "FAILURE": Status.FAILURE,
    "RUNNING": Status.RUNNING,
    "SKIPPED": Status.INVALID,
}


class Precondition(Decorator):
    """Decorator that ticks its child where the script `if` is true, and returns the status `else` otherwise.

    The condition is not checked again while the child runs.
    """

    names = ("Precondition",)
    PORTS: ClassVar[dict[str, Port]] = {"if": Port(str), "else": Port(str, "FAILURE")}

    def __init__(self, ports: Ports, context: TreeContext) -> None:
        super().__init__(ports, context)
        self._condition = Script(ports.get("if"), ports.where)
        if ports.get("else") not in _ELSE:
            raise TreeError(f"{ports.where}: else must be one of {', '.join(_ELSE)}, not {ports.get('else')!r}")

    def tick(self) -> Iterator[Any]:
        """Check the condition, and tick the child."""
        if self.decorated.status == Status.RUNNING or self._condition.run(self.ports.blackboard):
            yield from self.decorated.tick()
            self.status = self.decorated.status
        else:
            self.status = _ELSE[self.ports.get("else")]
        yield self
