"""Action nodes on the blackboard, and on time."""

from typing import ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.node import Node, Port, Ports, TreeContext
from daidalos.navigation.trees.scripts import Script as Program


class Script(Node):
    """Action node that executes a script, and succeeds."""

    names = ("Script",)
    PORTS: ClassVar[dict[str, Port]] = {"code": Port(str)}

    def __init__(self, ports: Ports, context: TreeContext) -> None:
        super().__init__(ports, context)
        self._program = Program(ports.get("code"), ports.where)

    def update(self) -> Status:
        """Execute the script."""
        self._program.run(self.ports.blackboard)
        return Status.SUCCESS


class SetBlackboard(Node):
    """Action node that sets the entry `output_key` of the blackboard to a text, or to the value of another entry."""

    names = ("SetBlackboard",)
    PORTS: ClassVar[dict[str, Port]] = {"value": Port(str), "output_key": Port(str)}

    def update(self) -> Status:
        """Set the entry."""
        self.ports.blackboard.set(self.ports.name_of("output_key"), self.ports.get("value"))
        return Status.SUCCESS


class UnsetBlackboard(Node):
    """Action node that removes the entry `key` of the blackboard."""

    names = ("UnsetBlackboard",)
    PORTS: ClassVar[dict[str, Port]] = {"key": Port(str)}

    def update(self) -> Status:
        """Remove the entry."""
        self.ports.blackboard.remove(self.ports.name_of("key"))
        return Status.SUCCESS


class Sleep(Node):
    """Action node that succeeds after a time `msec` [ms]."""

    names = ("Sleep",)
    PORTS: ClassVar[dict[str, Port]] = {"msec": Port(int)}

    def initialise(self) -> None:
        """Store the time of the start."""
        self._since = self.services.now()

    def update(self) -> Status:
        """Compare the times."""
        is_over = self.services.now() - self._since >= self.ports.get("msec") / 1000.0
        return Status.SUCCESS if is_over else Status.RUNNING
