"""Action node that drives backwards."""

from typing import ClassVar

from daidalos.navigation.trees.action_node import ActionNode, with_server
from daidalos.navigation.trees.node import Port, flag


class BackUp(ActionNode):
    """Action node that drives backwards by `backup_dist` [m]."""

    names = ("BackUp",)
    INTERFACE = "nav2_msgs/action/BackUp"
    SERVER = "backup"
    PORTS: ClassVar[dict[str, Port]] = with_server(
        {
            "backup_dist": Port(float, 0.15, field="target.x"),
            "backup_speed": Port(float, 0.025, field="speed"),
            "time_allowance": Port(float, 10.0),
            "disable_collision_checks": Port(flag, False),
        }
    )
    RECOVERY: ClassVar[bool] = True
