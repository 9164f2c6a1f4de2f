"""Condition node with a script."""

from typing import ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.node import Node, Port, Ports, TreeContext
from daidalos.navigation.trees.scripts import Script


class ScriptCondition(Node):
    """Condition node that succeeds where the value of a script is true."""

    names = ("ScriptCondition",)
    PORTS: ClassVar[dict[str, Port]] = {"code": Port(str)}

    def __init__(self, ports: Ports, context: TreeContext) -> None:
        super().__init__(ports, context)
        self._script = Script(ports.get("code"), ports.where)

    def update(self) -> Status:
        """Execute the script."""
        return Status.SUCCESS if self._script.run(self.ports.blackboard) else Status.FAILURE
