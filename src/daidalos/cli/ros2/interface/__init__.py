"""`ros2 interface`."""

from typing import ClassVar

from daidalos.cli.ros2.verbs import VerbCommand


class InterfaceCommand(VerbCommand):
    """Show information about ROS interfaces."""

    group = "ros2interface.verb"
    verbs: ClassVar = {
        "list": "List all interface types available",
        "package": "Output a list of available interface types within one package",
        "packages": "Output a list of packages that provide interfaces",
        "proto": "Output an interface prototype",
        "show": "Output the interface definition",
    }
