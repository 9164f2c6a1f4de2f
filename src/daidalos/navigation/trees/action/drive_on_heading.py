"""Action node that drives straight."""

from typing import ClassVar

from daidalos.navigation.trees.action_node import ActionNode, with_server
from daidalos.navigation.trees.node import Port, flag


class DriveOnHeading(ActionNode):
    """Action node that drives straight by `dist_to_travel` [m]."""

    names = ("DriveOnHeading",)
    INTERFACE = "nav2_msgs/action/DriveOnHeading"
    SERVER = "drive_on_heading"
    PORTS: ClassVar[dict[str, Port]] = with_server(
        {
            "dist_to_travel": Port(float, 0.15, field="target.x"),
            "speed": Port(float, 0.025),
            "time_allowance": Port(float, 10.0),
            "disable_collision_checks": Port(flag, False),
        }
    )
