"""Turn on the spot."""

from typing import ClassVar

from daidalos.navigation.trees.action.action_node import ActionNode, with_server
from daidalos.navigation.trees.node import Port, flag


class Spin(ActionNode):
    """Succeeds when the robot has turned by `spin_dist` [rad]."""

    PORTS: ClassVar[dict[str, Port]] = with_server(
        {
            "spin_dist": Port(float, 1.57),
            "time_allowance": Port(float, 10.0),
            "is_recovery": Port(flag, True),
            "disable_collision_checks": Port(flag, False),
        }
    )
