"""Condition nodes that detect a new goal."""

from typing import Any, ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.action_node import differs
from daidalos.navigation.trees.node import Node, Port, Ports, TreeContext, entry

GOALS: dict[str, Port] = {"goal": Port(entry, None), "goals": Port(entry, None)}
"""Ports of nodes that look at the goal; where the tree binds none, they are the blackboard's `goal` and `goals`."""


class GoalWatch:
    """Comparison of the goals on the blackboard with those of an earlier look.

    Parameters
    ----------
    ports : Ports
        Of a node with the ports `GOALS`.
    """

    def __init__(self, ports: Ports) -> None:
        self._ports = ports
        self._known: tuple[Any, Any] | None = None

    def has_changed(self, *, first: bool = False) -> bool:
        """Return whether a goal differs from that of the last look, `first` at the first one."""
        board = self._ports.blackboard
        given = tuple(self._ports.get(name) for name in GOALS)
        latest = tuple(board.get(name) if value is None else value for name, value in zip(GOALS, given, strict=True))
        known, self._known = self._known, latest
        if known is None:
            return first
        return any(differs(one, other) for one, other in zip(latest, known, strict=True))

    def reset(self) -> None:
        """Forget the last look."""
        self._known = None


class GoalUpdated(Node):
    """Condition node that succeeds when the goal differs from that at its last tick."""

    names = ("GoalUpdated",)
    PORTS: ClassVar[dict[str, Port]] = GOALS

    def __init__(self, ports: Ports, context: TreeContext) -> None:
        super().__init__(ports, context)
        self._goals = GoalWatch(ports)

    def update(self) -> Status:
        """Compare the goal with that of the last tick."""
        return Status.SUCCESS if self._goals.has_changed() else Status.FAILURE

    def terminate(self, new_status: Status) -> None:
        """Reset after a halt."""
        if new_status == Status.INVALID:
            self._goals.reset()


class GlobalUpdatedGoal(Node):
    """Condition node that succeeds at its first tick, and when the goal differs from that at its last one.

    A halt does not make it forget the goal.
    """

    names = ("GlobalUpdatedGoal",)
    PORTS: ClassVar[dict[str, Port]] = GOALS

    def __init__(self, ports: Ports, context: TreeContext) -> None:
        super().__init__(ports, context)
        self._goals = GoalWatch(ports)

    def update(self) -> Status:
        """Compare the goal with that of the last tick."""
        return Status.SUCCESS if self._goals.has_changed(first=True) else Status.FAILURE
