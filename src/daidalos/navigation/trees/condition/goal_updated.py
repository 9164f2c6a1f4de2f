"""Condition node that detects a new goal."""

from typing import Any, ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.action_node import differs
from daidalos.navigation.trees.node import Node, Port, Ports, TreeContext, entry


class GoalUpdated(Node):
    """Condition node that succeeds when `goal` on the blackboard differs from that at its first tick."""

    names = ("GoalUpdated",)
    PORTS: ClassVar[dict[str, Port]] = {"goal": Port(entry, None), "goals": Port(entry, None)}

    def __init__(self, ports: Ports, context: TreeContext) -> None:
        super().__init__(ports, context)
        self._known: tuple[Any, Any] | None = None

    def update(self) -> Status:
        """Compare the goal with that of the first tick."""
        board = self.ports.blackboard
        latest = (board.get("goal"), board.get("goals"))
        known, self._known = self._known, latest
        if known is None:
            return Status.FAILURE
        changed = any(differs(one, other) for one, other in zip(latest, known, strict=True))
        return Status.SUCCESS if changed else Status.FAILURE

    def terminate(self, new_status: Status) -> None:
        """Reset after a halt."""
        if new_status == Status.INVALID:
            self._known = None
