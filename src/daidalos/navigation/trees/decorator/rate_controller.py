"""Decorator that limits the tick rate of its child."""

from collections.abc import Iterator
from typing import Any, ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.errors import TreeError
from daidalos.navigation.trees.node import Decorator, Port, Ports, TreeContext


class RateController(Decorator):
    """Decorator that ticks its child while it runs, else at `hz`; in between it repeats the status."""

    names = ("RateController",)
    PORTS: ClassVar[dict[str, Port]] = {"hz": Port(float, 10.0)}

    def __init__(self, ports: Ports, context: TreeContext) -> None:
        super().__init__(ports, context)
        if not ports.get("hz") > 0.0:
            raise TreeError(f"{ports.where}: hz must be greater than 0, not {ports.get('hz')}")
        self._last: float | None = None

    def tick(self) -> Iterator[Any]:
        """Tick the child if it is due."""
        now = self.services.now()
        waiting = self._last is not None and now - self._last < 1.0 / self.ports.get("hz") - 1e-9
        if self.decorated.status == Status.RUNNING or self.status == Status.INVALID or not waiting:
            if self.decorated.status != Status.RUNNING:
                self._last = now
            yield from self.decorated.tick()
            self.status = self.update()
        yield self

    def terminate(self, new_status: Status) -> None:
        """Reset after a halt."""
        if new_status == Status.INVALID:
            self._last = None
