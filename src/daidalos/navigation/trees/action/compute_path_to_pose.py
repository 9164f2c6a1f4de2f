"""Plan a path to a pose."""

from typing import ClassVar

from daidalos.navigation.trees.action.action_node import ActionNode, with_server
from daidalos.navigation.trees.node import Port, entry


class ComputePathToPose(ActionNode):
    """Succeeds with a path."""

    PORTS: ClassVar[dict[str, Port]] = with_server(
        {
            "goal": Port(entry),
            "start": Port(entry, None),
            "planner_id": Port(str, ""),
            "path": Port(entry, output=True),
        }
    )
