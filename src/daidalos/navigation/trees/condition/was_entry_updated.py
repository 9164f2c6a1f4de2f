"""Condition node on writes to the blackboard."""

from typing import ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.node import Node, Port


class WasEntryUpdated(Node):
    """Condition node that succeeds where `entry` was written since its last tick."""

    names = ("WasEntryUpdated", "EntryUpdated")
    PORTS: ClassVar[dict[str, Port]] = {"entry": Port(str)}
    _seen = 0

    def update(self) -> Status:
        """Compare the number of writes."""
        revision = self.ports.blackboard.revision(self.ports.name_of("entry"))
        known, self._seen = self._seen, revision
        return Status.SUCCESS if revision != known else Status.FAILURE
