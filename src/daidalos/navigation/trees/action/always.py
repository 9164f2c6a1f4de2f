"""Action nodes that do nothing."""

from py_trees.common import Status

from daidalos.navigation.trees.node import Node


class AlwaysSuccess(Node):
    """Action node that succeeds."""

    names = ("AlwaysSuccess",)

    def update(self) -> Status:
        """Return success."""
        return Status.SUCCESS


class AlwaysFailure(Node):
    """Action node that fails."""

    names = ("AlwaysFailure",)

    def update(self) -> Status:
        """Return failure."""
        return Status.FAILURE
