"""Condition nodes for errors that a recovery may resolve."""

from typing import ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.node import Node, Port


class WouldAPlannerRecoveryHelp(Node):
    """Condition node that succeeds for planner errors that a recovery may resolve."""

    names = ("WouldAPlannerRecoveryHelp",)
    PORTS: ClassVar[dict[str, Port]] = {"error_code": Port(str)}
    HELPED: ClassVar[frozenset[str]] = frozenset({"UNKNOWN", "NO_VALID_PATH", "TIMEOUT"})

    def update(self) -> Status:
        """Check the name of the error code."""
        return Status.SUCCESS if self.ports.get("error_code") in self.HELPED else Status.FAILURE


class WouldAControllerRecoveryHelp(WouldAPlannerRecoveryHelp):
    """Condition node that succeeds for controller errors that a recovery may resolve."""

    names = ("WouldAControllerRecoveryHelp",)
    HELPED: ClassVar[frozenset[str]] = frozenset(
        {"UNKNOWN", "PATIENCE_EXCEEDED", "FAILED_TO_MAKE_PROGRESS", "NO_VALID_CONTROL"}
    )


class WouldARouteRecoveryHelp(WouldAPlannerRecoveryHelp):
    """Condition node that succeeds for errors of routes that a recovery may resolve."""

    names = ("WouldARouteRecoveryHelp",)
    HELPED: ClassVar[frozenset[str]] = frozenset({"UNKNOWN", "NO_VALID_ROUTE", "TIMEOUT"})


class WouldASmootherRecoveryHelp(WouldAPlannerRecoveryHelp):
    """Condition node that succeeds for smoother errors that a recovery may resolve."""

    names = ("WouldASmootherRecoveryHelp",)
    HELPED: ClassVar[frozenset[str]] = frozenset(
        {"UNKNOWN", "TIMEOUT", "FAILED_TO_SMOOTH_PATH", "SMOOTHED_PATH_IN_COLLISION"}
    )
