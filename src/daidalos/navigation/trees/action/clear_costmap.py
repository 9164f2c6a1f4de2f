"""Action nodes that clear costmaps."""

from typing import ClassVar

from daidalos.navigation.trees.action_node import ActionNode
from daidalos.navigation.trees.node import Port, entry

_SERVICE = {"service_name": Port(str), "server_timeout": Port(float, None)}


class ClearEntireCostmap(ActionNode):
    """Action node that clears the entire costmap."""

    names = ("ClearEntireCostmap",)
    INTERFACE = "nav2_msgs/srv/ClearEntireCostmap"
    PORTS: ClassVar[dict[str, Port]] = _SERVICE
    RECOVERY: ClassVar[bool] = True


class ClearCostmapAroundRobot(ActionNode):
    """Action node that clears a square with an edge [m] around the robot."""

    names = ("ClearCostmapAroundRobot",)
    INTERFACE = "nav2_msgs/srv/ClearCostmapAroundRobot"
    PORTS: ClassVar[dict[str, Port]] = {**_SERVICE, "reset_distance": Port(float, 1.0)}
    RECOVERY: ClassVar[bool] = True


class ClearCostmapExceptRegion(ActionNode):
    """Action node that clears the outside of a square with an edge [m] around the robot."""

    names = ("ClearCostmapExceptRegion",)
    INTERFACE = "nav2_msgs/srv/ClearCostmapExceptRegion"
    PORTS: ClassVar[dict[str, Port]] = {**_SERVICE, "reset_distance": Port(float, 1.0)}
    RECOVERY: ClassVar[bool] = True


class ClearCostmapAroundPose(ActionNode):
    """Action node that clears a square with an edge [m] around a pose."""

    names = ("ClearCostmapAroundPose",)
    INTERFACE = "nav2_msgs/srv/ClearCostmapAroundPose"
    PORTS: ClassVar[dict[str, Port]] = {**_SERVICE, "pose": Port(entry), "reset_distance": Port(float, 1.0)}
    RECOVERY: ClassVar[bool] = True
