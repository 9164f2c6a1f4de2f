"""`ros2 pkg`."""

from typing import ClassVar

from daidalos.cli.ros2.verbs import VerbCommand


class PkgCommand(VerbCommand):
    """Various package related sub-commands."""

    group = "ros2pkg.verb"
    verbs: ClassVar = {
        "create": "Create a new ROS 2 package",
        "executables": "Output a list of package specific executables",
        "list": "Output a list of available packages",
        "prefix": "Output the prefix path of a package",
        "xml": "Output the XML of the package manifest or a specific tag",
    }
