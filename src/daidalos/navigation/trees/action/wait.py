"""Behavior that waits."""

from typing import ClassVar

from daidalos.navigation.trees.action_node import ActionNode, with_server
from daidalos.navigation.trees.node import Port


class Wait(ActionNode):
    """Action node that waits for `wait_duration` [s]."""

    names = ("Wait",)
    INTERFACE = "nav2_msgs/action/Wait"
    SERVER = "wait"
    PORTS: ClassVar[dict[str, Port]] = with_server({"wait_duration": Port(float, 1.0, field="time")})
    RECOVERY: ClassVar[bool] = True
