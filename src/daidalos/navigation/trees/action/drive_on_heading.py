"""Drive straight for a distance."""

from typing import ClassVar

from daidalos.navigation.trees.action.action_node import ActionNode, with_server
from daidalos.navigation.trees.node import Port, flag


class DriveOnHeading(ActionNode):
    """Succeeds when the robot has driven `dist_to_travel` [m]."""

    PORTS: ClassVar[dict[str, Port]] = with_server(
        {
            "dist_to_travel": Port(float, 0.15),
            "speed": Port(float, 0.025),
            "time_allowance": Port(float, 10.0),
            "disable_collision_checks": Port(flag, False),
        }
    )
