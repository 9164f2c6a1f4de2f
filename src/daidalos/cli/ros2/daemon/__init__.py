"""`ros2 daemon`: background process that keeps the graph discovered for the other verbs."""

from typing import ClassVar

from daidalos.cli.ros2.verbs import VerbCommand


class DaemonCommand(VerbCommand):
    """Various daemon related sub-commands."""

    group = "ros2cli.daemon.verb"
    verbs: ClassVar = {
        "start": "Start the daemon if it isn't running",
        "status": "Output the status of the daemon",
        "stop": "Stop the daemon if it is running",
    }
