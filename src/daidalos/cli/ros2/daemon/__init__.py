"""`ros2 daemon`: a process in the background that knows the graph, so that verbs need not look for it."""

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
