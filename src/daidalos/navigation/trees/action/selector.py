"""Say which planner or controller the nodes that follow shall use."""

from typing import ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.node import Node, Port


class PlannerSelector(Node):
    """Writes the planner that was chosen last, or the default."""

    names = ("PlannerSelector",)
    PORTS: ClassVar[dict[str, Port]] = {
        "default_planner": Port(str),
        "topic_name": Port(str, "planner_selector"),
        "selected_planner": Port(str, output=True),
    }

    def update(self) -> Status:
        """Succeed at once."""
        _choose(self, "planner")
        return Status.SUCCESS


class ControllerSelector(Node):
    """Writes the controller that was chosen last, or the default."""

    names = ("ControllerSelector",)
    PORTS: ClassVar[dict[str, Port]] = {
        "default_controller": Port(str),
        "topic_name": Port(str, "controller_selector"),
        "selected_controller": Port(str, output=True),
    }

    def update(self) -> Status:
        """Succeed at once."""
        _choose(self, "controller")
        return Status.SUCCESS


def _choose(node: Node, kind: str) -> None:
    """Take what the blackboard holds under the topic's name, where the shell writes what it hears."""
    chosen = node.ports.blackboard.get(node.ports.get("topic_name"))
    node.ports.set(f"selected_{kind}", chosen or node.ports.get(f"default_{kind}"))
