"""Action node for a person who drives."""

from typing import ClassVar

from daidalos.navigation.trees.action_node import ActionNode, with_server
from daidalos.navigation.trees.node import Port, flag


class AssistedTeleop(ActionNode):
    """Action node that passes a person's velocities on, slower before obstacles."""

    names = ("AssistedTeleop",)
    INTERFACE = "nav2_msgs/action/AssistedTeleop"
    SERVER = "assisted_teleop"
    PORTS: ClassVar[dict[str, Port]] = with_server(
        {"time_allowance": Port(float, 10.0), "is_recovery": Port(flag, False)}
    )
