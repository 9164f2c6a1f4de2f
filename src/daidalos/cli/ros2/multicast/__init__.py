"""`ros2 multicast`."""

from typing import ClassVar

from daidalos.cli.ros2.verbs import VerbCommand


class MulticastCommand(VerbCommand):
    """Various multicast related sub-commands."""

    group = "ros2multicast.verb"
    verbs: ClassVar = {
        "receive": "Receive a single UDP multicast packet",
        "send": "Send a single UDP multicast packet",
    }
