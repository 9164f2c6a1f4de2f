"""`ros2 lifecycle`."""

from typing import ClassVar

from daidalos.cli.ros2.verbs import VerbCommand


class LifecycleCommand(VerbCommand):
    """Various lifecycle related sub-commands."""

    group = "ros2lifecycle.verb"
    verbs: ClassVar = {
        "get": "Get lifecycle state for one or more nodes",
        "list": "Output a list of available transitions",
        "nodes": "Output a list of nodes with lifecycle",
        "set": "Trigger lifecycle state transition",
    }
