"""Action nodes that navigate by other trees."""

from typing import ClassVar

from daidalos.navigation.trees.action_node import ActionNode, with_server
from daidalos.navigation.trees.node import Port, entry


class NavigateToPose(ActionNode):
    """Action node that navigates to a pose."""

    names = ("NavigateToPose",)
    INTERFACE = "nav2_msgs/action/NavigateToPose"
    SERVER = "navigate_to_pose"
    PORTS: ClassVar[dict[str, Port]] = with_server(
        {"goal": Port(entry, field="pose"), "behavior_tree": Port(str, "")},
    )


class NavigateThroughPoses(ActionNode):
    """Action node that navigates through poses."""

    names = ("NavigateThroughPoses",)
    INTERFACE = "nav2_msgs/action/NavigateThroughPoses"
    SERVER = "navigate_through_poses"
    PORTS: ClassVar[dict[str, Port]] = with_server(
        {"goals": Port(entry, field="poses"), "behavior_tree": Port(str, "")},
    )
