"""Decorator for a detour shortly before the goal."""

from collections.abc import Iterator
from itertools import pairwise
from math import hypot
from typing import Any, ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.node import Decorator, Port, Ports, TreeContext, entry


class PathLongerOnApproach(Decorator):
    """Decorator that ticks its child when a new path to the same goal is much longer than the last one.

    The child is ticked where the last path was shorter than `prox_len` [m], and the new one is longer than
    `length_factor` times that; it succeeds otherwise.
    """

    names = ("PathLongerOnApproach",)
    PORTS: ClassVar[dict[str, Port]] = {
        "path": Port(entry),
        "prox_len": Port(float, 3.0),
        "length_factor": Port(float, 2.0),
    }

    def __init__(self, ports: Ports, context: TreeContext) -> None:
        super().__init__(ports, context)
        self._last: Any = None

    def tick(self) -> Iterator[Any]:
        """Tick the child for a detour, and while it runs."""
        path = self.ports.get("path")
        if self.decorated.status == Status.RUNNING or self._is_detour(path):
            yield from self.decorated.tick()
            self.status = self.decorated.status
        else:
            self.status = Status.SUCCESS
        if self.status != Status.RUNNING:
            self._last = path
        yield self

    def _is_detour(self, path: Any) -> bool:
        last = self._last
        if last is None or path is None or path is last or not last.poses or not path.poses:
            return False
        if last.poses[-1].pose != path.poses[-1].pose:
            return False
        before = _length(last)
        return bool(before < self.ports.get("prox_len") and _length(path) > self.ports.get("length_factor") * before)


def _length(path: Any) -> float:
    places = [pose.pose.position for pose in path.poses]
    return sum(hypot(b.x - a.x, b.y - a.y) for a, b in pairwise(places))
