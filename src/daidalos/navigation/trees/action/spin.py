"""Action node that rotates in place."""

from typing import ClassVar

from daidalos.navigation.trees.action_node import ActionNode, with_server
from daidalos.navigation.trees.node import Port, flag


class Spin(ActionNode):
    """Action node that rotates in place by `spin_dist` [rad]."""

    names = ("Spin",)
    INTERFACE = "nav2_msgs/action/Spin"
    SERVER = "spin"
    PORTS: ClassVar[dict[str, Port]] = with_server(
        {
            "spin_dist": Port(float, 1.57, field="target_yaw"),
            "time_allowance": Port(float, 10.0),
            "is_recovery": Port(flag, True),
            "disable_collision_checks": Port(flag, False),
        }
    )
