"""`ros2 component`."""

from typing import ClassVar

from daidalos.cli.ros2.verbs import VerbCommand


class ComponentCommand(VerbCommand):
    """Various component related sub-commands."""

    group = "ros2component.verb"
    verbs: ClassVar = {
        "list": "Output a list of running containers and components",
        "load": "Load a component into a container node",
        "standalone": "Run a component into its own standalone container node",
        "types": "Output a list of components registered in the ament index",
        "unload": "Unload a component from a container node",
    }
