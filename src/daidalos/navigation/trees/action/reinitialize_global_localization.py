"""Action node that makes the localization search everywhere."""

from typing import ClassVar

from daidalos.navigation.trees.action_node import ActionNode
from daidalos.navigation.trees.node import Port


class ReinitializeGlobalLocalization(ActionNode):
    """Action node that calls the service that spreads the localization's particles over the map."""

    names = ("ReinitializeGlobalLocalization",)
    INTERFACE = "std_srvs/srv/Empty"
    SERVER = "reinitialize_global_localization"
    PORTS: ClassVar[dict[str, Port]] = {"service_name": Port(str, None), "server_timeout": Port(float, None)}
