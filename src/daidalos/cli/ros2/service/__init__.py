"""`ros2 service`."""

from argparse import ArgumentParser
from typing import ClassVar

from daidalos.cli.ros2.verbs import VerbCommand


class ServiceCommand(VerbCommand):
    """Various service related sub-commands."""

    group = "ros2service.verb"
    verbs: ClassVar = {
        "call": "Call a service",
        "echo": "Echo a service",
        "find": "Output a list of available services of a given type",
        "info": "Print information about a service",
        "list": "Output a list of available services",
        "type": "Output a service's type",
    }

    def add_options(self, parser: ArgumentParser) -> None:
        """Declare the options common to all verbs."""
        parser.add_argument("--include-hidden-services", action="store_true", help="Consider hidden services as well")
