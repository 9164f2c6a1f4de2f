"""A condition for behaviour trees: whether a path is short."""

from typing import ClassVar

from py_trees.common import Status

from daidalos.navigation.paths import path_length
from daidalos.navigation.trees.node import Node, Port, entry
from daidalos.nodes.conversions import path_array


class IsPathShort(Node):
    """Succeeds where the path is at most `max_length` [m] long."""

    PORTS: ClassVar = {"path": Port(entry), "max_length": Port(float, 5.0)}

    def update(self):
        path = self.ports.get("path")
        if path is None:
            return Status.FAILURE
        return Status.SUCCESS if path_length(path_array(path)) <= self.ports.get("max_length") else Status.FAILURE
