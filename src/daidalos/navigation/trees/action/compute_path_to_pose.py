"""Action node that plans a path to a pose."""

from collections.abc import Mapping
from typing import Any, ClassVar

from daidalos.navigation.trees.action_node import ActionNode, with_server
from daidalos.navigation.trees.node import Port, entry


class ComputePathToPose(ActionNode):
    """Action node that plans a path to a pose."""

    names = ("ComputePathToPose",)
    INTERFACE = "nav2_msgs/action/ComputePathToPose"
    SERVER = "compute_path_to_pose"
    PORTS: ClassVar[dict[str, Port]] = with_server(
        {
            "goal": Port(entry),
            "start": Port(entry, None),
            "planner_id": Port(str, ""),
            "path": Port(entry, output=True),
        }
    )

    @classmethod
    def goal(cls, inputs: Mapping[str, Any]) -> dict[str, Any]:
        """Implement `ActionNode.goal`."""
        return {**inputs, "use_start": "start" in inputs}
