"""Action nodes that select the planner or controller of later nodes."""

from typing import ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.node import Node, Port


class PlannerSelector(Node):
    """Action node that outputs the last selected planner, or the default."""

    names = ("PlannerSelector",)
    PORTS: ClassVar[dict[str, Port]] = {
        "default_planner": Port(str),
        "topic_name": Port(str, "planner_selector"),
        "selected_planner": Port(str, output=True),
    }

    def update(self) -> Status:
        """Return success."""
        _choose(self, "planner")
        return Status.SUCCESS


class ControllerSelector(Node):
    """Action node that outputs the last selected controller, or the default."""

    names = ("ControllerSelector",)
    PORTS: ClassVar[dict[str, Port]] = {
        "default_controller": Port(str),
        "topic_name": Port(str, "controller_selector"),
        "selected_controller": Port(str, output=True),
    }

    def update(self) -> Status:
        """Return success."""
        _choose(self, "controller")
        return Status.SUCCESS


def _choose(node: Node, kind: str) -> None:
    """Read the selection from the blackboard under the topic's name, where the node writes received messages."""
    chosen = node.ports.blackboard.get(node.ports.get("topic_name"))
    node.ports.set(f"selected_{kind}", chosen or node.ports.get(f"default_{kind}"))
