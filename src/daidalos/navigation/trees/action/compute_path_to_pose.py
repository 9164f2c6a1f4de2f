"""Action nodes that plan paths to a pose and through poses."""

from collections.abc import Mapping
from typing import Any, ClassVar

from daidalos.navigation.trees.action.poses import goals_of
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


class ComputePathThroughPoses(ActionNode):
    """Action node that plans a path through poses."""

    names = ("ComputePathThroughPoses",)
    INTERFACE = "nav2_msgs/action/ComputePathThroughPoses"
    SERVER = "compute_path_through_poses"
    PORTS: ClassVar[dict[str, Port]] = with_server(
        {
            "goals": Port(entry),
            "start": Port(entry, None),
            "planner_id": Port(str, ""),
            "path": Port(entry, output=True),
        }
    )

    @classmethod
    def goal(cls, inputs: Mapping[str, Any]) -> dict[str, Any]:
        """Implement `ActionNode.goal`."""
        return {**inputs, "use_start": "start" in inputs, "goals": goals_of(inputs.get("goals"))}
