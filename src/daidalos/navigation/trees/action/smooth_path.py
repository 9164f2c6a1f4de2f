"""Smooth a path."""

from typing import ClassVar

from daidalos.navigation.trees.action_node import ActionNode, with_server
from daidalos.navigation.trees.node import Port, entry, flag


class SmoothPath(ActionNode):
    """Action node that smooths a path."""

    names = ("SmoothPath",)
    INTERFACE = "nav2_msgs/action/SmoothPath"
    SERVER = "smooth_path"
    PORTS: ClassVar[dict[str, Port]] = with_server(
        {
            "unsmoothed_path": Port(entry, field="path"),
            "smoother_id": Port(str, ""),
            "max_smoothing_duration": Port(float, 3.0),
            "check_for_collisions": Port(flag, False),
            "smoothed_path": Port(entry, output=True, field="path"),
            "smoothing_duration": Port(float, output=True),
            "was_completed": Port(flag, output=True),
        }
    )
