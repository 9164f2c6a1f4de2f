"""Whether clearing costmaps or moving could help against an error."""

from typing import ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.node import Node, Port


class WouldAPlannerRecoveryHelp(Node):
    """Succeeds for errors of a planner that another costmap may spare."""

    names = ("WouldAPlannerRecoveryHelp",)
    PORTS: ClassVar[dict[str, Port]] = {"error_code": Port(str)}
    HELPED: ClassVar[frozenset[str]] = frozenset({"UNKNOWN", "NO_VALID_PATH", "TIMEOUT"})

    def update(self) -> Status:
        """Look at the name of the error code."""
        return Status.SUCCESS if self.ports.get("error_code") in self.HELPED else Status.FAILURE


class WouldAControllerRecoveryHelp(WouldAPlannerRecoveryHelp):
    """Succeeds for errors of a controller that another costmap may spare."""

    names = ("WouldAControllerRecoveryHelp",)
    HELPED: ClassVar[frozenset[str]] = frozenset(
        {"UNKNOWN", "PATIENCE_EXCEEDED", "FAILED_TO_MAKE_PROGRESS", "NO_VALID_CONTROL"}
    )
