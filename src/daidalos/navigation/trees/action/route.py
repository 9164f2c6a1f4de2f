"""Action nodes that find routes through graphs and track the robot along them."""

from typing import Any, ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.action.cancel import CancelGoals
from daidalos.navigation.trees.action_node import ActionNode, with_server
from daidalos.navigation.trees.node import Node, Port, entry, flag

_REQUEST: dict[str, Port] = {
    "start_id": Port(int, None),
    "goal_id": Port(int, None),
    "start": Port(entry, None),
    "goal": Port(entry, None),
    "use_start": Port(flag, False),
    "use_poses": Port(flag, False),
}


class ComputeRoute(ActionNode):
    """Action node that finds a route."""

    names = ("ComputeRoute",)
    INTERFACE = "nav2_msgs/action/ComputeRoute"
    SERVER = "compute_route"
    PORTS: ClassVar[dict[str, Port]] = with_server(
        {
            **_REQUEST,
            "planning_time": Port(entry, output=True),
            "path": Port(entry, output=True),
            "route": Port(entry, output=True),
        }
    )


class ComputeAndTrackRoute(ActionNode):
    """Action node that finds a route and tracks the robot to its end, with the progress as outputs."""

    names = ("ComputeAndTrackRoute",)
    INTERFACE = "nav2_msgs/action/ComputeAndTrackRoute"
    SERVER = "compute_and_track_route"
    UPDATES = tuple(_REQUEST)
    HAS_FEEDBACK = True
    PORTS: ClassVar[dict[str, Port]] = with_server(
        {
            **_REQUEST,
            "execution_duration": Port(entry, output=True),
            "execution_time": Port(entry, output=True, field="execution_duration"),
            "last_node_id": Port(int, output=True),
            "next_node_id": Port(int, output=True),
            "current_edge_id": Port(int, output=True),
            "route": Port(entry, output=True),
            "path": Port(entry, output=True),
            "rerouted": Port(flag, output=True),
        }
    )


class CancelComputeAndTrackRoute(CancelGoals):
    """Action node that cancels the tracking of routes."""

    names = ("CancelComputeAndTrackRoute",)
    ACTION = "compute_and_track_route"


class ExtractRouteNodesAsGoals(Node):
    """Action node that outputs the nodes of a route as goals."""

    names = ("ExtractRouteNodesAsGoals",)
    PORTS: ClassVar[dict[str, Port]] = {"route": Port(entry), "goals": Port(entry, output=True)}

    def update(self) -> Status:
        """Make a goal of each node; fail where there is none."""
        from geometry_msgs.msg import Point, Pose, PoseStamped

        route: Any = self.ports.get("route")
        if route is None or not route.nodes:
            return Status.FAILURE
        places = [Point(x=node.position.x, y=node.position.y) for node in route.nodes]
        self.ports.set("goals", [PoseStamped(header=route.header, pose=Pose(position=place)) for place in places])
        return Status.SUCCESS
