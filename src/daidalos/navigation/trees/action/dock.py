"""Action nodes that dock and undock the robot."""

from typing import ClassVar

from daidalos.navigation.trees.action_node import ActionNode, with_server
from daidalos.navigation.trees.node import Port, entry, flag


class DockRobot(ActionNode):
    """Action node that docks the robot at a dock that the server knows, or at a pose."""

    names = ("DockRobot",)
    INTERFACE = "nav2_msgs/action/DockRobot"
    SERVER = "dock_robot"
    PORTS: ClassVar[dict[str, Port]] = with_server(
        {
            "use_dock_id": Port(flag, True),
            "dock_id": Port(str, None),
            "dock_pose": Port(entry, None),
            "dock_type": Port(str, None),
            "max_staging_time": Port(float, 1000.0),
            "navigate_to_staging_pose": Port(flag, True),
            "success": Port(flag, output=True),
            "num_retries": Port(int, output=True),
        }
    )


class UndockRobot(ActionNode):
    """Action node that takes the robot off its dock."""

    names = ("UndockRobot",)
    INTERFACE = "nav2_msgs/action/UndockRobot"
    SERVER = "undock_robot"
    PORTS: ClassVar[dict[str, Port]] = with_server(
        {
            "dock_type": Port(str, None),
            "max_undocking_time": Port(float, 30.0),
            "success": Port(flag, output=True),
        }
    )
