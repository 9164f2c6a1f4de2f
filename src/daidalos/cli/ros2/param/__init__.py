"""`ros2 param`."""

from typing import ClassVar

from daidalos.cli.ros2.verbs import VerbCommand


class ParamCommand(VerbCommand):
    """Various param related sub-commands."""

    group = "ros2param.verb"
    verbs: ClassVar = {
        "delete": "Delete parameter",
        "describe": "Show descriptive information about declared parameters",
        "dump": "Show all of the parameters of a node in a YAML file format",
        "get": "Get parameter",
        "list": "Output a list of available parameters",
        "load": "Load parameter file for a node",
        "set": "Set parameter",
    }
