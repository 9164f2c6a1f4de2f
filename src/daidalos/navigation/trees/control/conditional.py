"""Nodes that choose one of their children: by a condition, or by a value."""

from collections.abc import Iterator
from typing import Any, ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.node import Control, Port
from daidalos.navigation.trees.scripts import equal


class _Choosing(Control):
    """Control node that ticks one child, and ends as it does; another child that runs is halted."""

    def _tick_chosen(self, chosen: int) -> Iterator[Any]:
        """Tick a child; fail where there is none of that index."""
        if chosen >= len(self.children):
            self.conclude(Status.FAILURE)
            return
        self.current_child = self.children[chosen]
        yield from self.current_child.tick()
        self.conclude(self.current_child.status, runs=self.current_child)


class IfThenElse(_Choosing):
    """Control node that ticks its second child after a success of the first one, and the third after a failure.

    The condition is not checked again while the chosen child runs. Without a third child it fails with the condition.
    """

    names = ("IfThenElse",)
    CHILDREN: ClassVar[tuple[int, int | None]] = (2, 3)
    _chosen = 0

    def tick(self) -> Iterator[Any]:
        """Tick the condition until it ends, then the chosen child."""
        if self.status != Status.RUNNING:
            self._chosen = 0
        if not self._chosen:
            condition = self.children[0]
            yield from condition.tick()
            if condition.status not in (Status.SUCCESS, Status.FAILURE):
                self.conclude(condition.status)
                yield self
                return
            self._chosen = 1 if condition.status == Status.SUCCESS else 2
        yield from self._tick_chosen(self._chosen)
        yield self


class WhileDoElse(_Choosing):
    """Control node that checks its first child at every tick, and ticks the second or third one, as `IfThenElse`."""

    names = ("WhileDoElse",)
    CHILDREN: ClassVar[tuple[int, int | None]] = (2, 3)

    def tick(self) -> Iterator[Any]:
        """Tick the condition, then the chosen child."""
        condition = self.children[0]
        yield from condition.tick()
        if condition.status in (Status.SUCCESS, Status.FAILURE):
            yield from self._tick_chosen(1 if condition.status == Status.SUCCESS else 2)
        else:
            self.conclude(condition.status, runs=condition)
        yield self


def _ports(cases: int) -> dict[str, Port]:
    return {"variable": Port(str), **{f"case_{number}": Port(str) for number in range(1, cases + 1)}}


class Switch2(_Choosing):
    """Control node that ticks the child of the case that `variable` equals, and the last one where it equals none."""

    names = ("Switch2",)
    CASES: ClassVar[int] = 2
    PORTS: ClassVar[dict[str, Port]] = _ports(2)
    CHILDREN: ClassVar[tuple[int, int | None]] = (3, 3)

    def tick(self) -> Iterator[Any]:
        """Tick the child of the case."""
        value = self.ports.get("variable")
        cases = range(1, self.CASES + 1)
        chosen = next((case for case in cases if equal(value, self.ports.get(f"case_{case}"))), self.CASES + 1)
        yield from self._tick_chosen(chosen - 1)
        yield self


class Switch3(Switch2):
    """Switch of three cases."""

    names = ("Switch3",)
    CASES = 3
    PORTS: ClassVar[dict[str, Port]] = _ports(3)
    CHILDREN: ClassVar[tuple[int, int | None]] = (4, 4)


class Switch4(Switch2):
    """Switch of four cases."""

    names = ("Switch4",)
    CASES = 4
    PORTS: ClassVar[dict[str, Port]] = _ports(4)
    CHILDREN: ClassVar[tuple[int, int | None]] = (5, 5)


class Switch5(Switch2):
    """Switch of five cases."""

    names = ("Switch5",)
    CASES = 5
    PORTS: ClassVar[dict[str, Port]] = _ports(5)
    CHILDREN: ClassVar[tuple[int, int | None]] = (6, 6)


class Switch6(Switch2):
    """Switch of six cases."""

    names = ("Switch6",)
    CASES = 6
    PORTS: ClassVar[dict[str, Port]] = _ports(6)
    CHILDREN: ClassVar[tuple[int, int | None]] = (7, 7)
