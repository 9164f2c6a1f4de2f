"""Action node that follows a path."""

from typing import ClassVar

from daidalos.navigation.trees.action_node import ActionNode, with_server
from daidalos.navigation.trees.node import Port, entry


class FollowPath(ActionNode):
    """Action node that follows a path; a new path replaces it while running."""

    names = ("FollowPath",)
    INTERFACE = "nav2_msgs/action/FollowPath"
    SERVER = "follow_path"
    PORTS: ClassVar[dict[str, Port]] = with_server(
        {
            "path": Port(entry),
            "controller_id": Port(str, ""),
            "goal_checker_id": Port(str, ""),
            "progress_checker_id": Port(str, ""),
        }
    )
    UPDATES: ClassVar[tuple[str, ...]] = ("path", "controller_id", "goal_checker_id", "progress_checker_id")
