"""Behavior that waits."""

from collections.abc import Mapping
from typing import Any, ClassVar

from daidalos.navigation.trees.action_node import ActionNode, with_server
from daidalos.navigation.trees.node import Port


class Wait(ActionNode):
    """Action node that waits for `wait_duration` [s]."""

    names = ("Wait",)
    INTERFACE = "nav2_msgs/action/Wait"
    SERVER = "wait"
    PORTS: ClassVar[dict[str, Port]] = with_server({"wait_duration": Port(float, 1.0)})
    RECOVERY: ClassVar[bool] = True

    @classmethod
    def goal(cls, inputs: Mapping[str, Any]) -> dict[str, Any]:
        """Implement `ActionNode.goal`."""
        return {**inputs, "time": inputs["wait_duration"]}
