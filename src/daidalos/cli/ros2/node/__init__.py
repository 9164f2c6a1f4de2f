"""`ros2 node`."""

from typing import ClassVar

from daidalos.cli.ros2.verbs import VerbCommand


class NodeCommand(VerbCommand):
    """Various node related sub-commands."""

    group = "ros2node.verb"
    verbs: ClassVar = {
        "info": "Output information about a node",
        "list": "Output a list of available nodes",
    }
