"""Stand still for a while."""

from typing import ClassVar

from daidalos.navigation.trees.action.action_node import ActionNode, with_server
from daidalos.navigation.trees.node import Port


class Wait(ActionNode):
    """Succeeds after `wait_duration` [s]."""

    PORTS: ClassVar[dict[str, Port]] = with_server({"wait_duration": Port(float, 1.0)})
    RECOVERY: ClassVar[bool] = True
