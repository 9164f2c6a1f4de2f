"""Condition node that asks whether a path is still free."""

from typing import Any, ClassVar

from daidalos.navigation.trees.action_node import ActionNode
from daidalos.navigation.trees.node import Port, entry, flag


class IsPathValid(ActionNode):
    """Condition node that succeeds where the planner server finds no obstacle on a path."""

    names = ("IsPathValid",)
    INTERFACE = "nav2_msgs/srv/IsPathValid"
    SERVER = "is_path_valid"
    PORTS: ClassVar[dict[str, Port]] = {
        "path": Port(entry, None),
        "max_cost": Port(int, 254),
        "consider_unknown_as_obstacle": Port(flag, False),
        "service_name": Port(str, None),
        "server_timeout": Port(float, None),
    }

    @classmethod
    def is_success(cls, response: Any) -> bool:
        """Implement `ActionNode.is_success`."""
        return bool(response.is_valid)
