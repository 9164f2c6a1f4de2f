"""Make a costmap forget what sensors saw."""

from typing import ClassVar

from daidalos.navigation.trees.action_node import ActionNode
from daidalos.navigation.trees.node import Port

_SERVICE = {"service_name": Port(str), "server_timeout": Port(float, None)}


class ClearEntireCostmap(ActionNode):
    """Clears all of it."""

    names = ("ClearEntireCostmap",)
    INTERFACE = "nav2_msgs/srv/ClearEntireCostmap"
    PORTS: ClassVar[dict[str, Port]] = _SERVICE
    RECOVERY: ClassVar[bool] = True


class ClearCostmapAroundRobot(ActionNode):
    """Clears a square of an edge [m] around the robot."""

    names = ("ClearCostmapAroundRobot",)
    INTERFACE = "nav2_msgs/srv/ClearCostmapAroundRobot"
    PORTS: ClassVar[dict[str, Port]] = {**_SERVICE, "reset_distance": Port(float, 1.0)}
    RECOVERY: ClassVar[bool] = True


class ClearCostmapExceptRegion(ActionNode):
    """Clears what is outside of a square of an edge [m] around the robot."""

    names = ("ClearCostmapExceptRegion",)
    INTERFACE = "nav2_msgs/srv/ClearCostmapExceptRegion"
    PORTS: ClassVar[dict[str, Port]] = {**_SERVICE, "reset_distance": Port(float, 1.0)}
    RECOVERY: ClassVar[bool] = True
