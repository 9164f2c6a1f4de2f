"""`ros2 topic`."""

from argparse import ArgumentParser
from typing import ClassVar

from daidalos.cli.ros2.verbs import VerbCommand


class TopicCommand(VerbCommand):
    """Various topic related sub-commands."""

    group = "ros2topic.verb"
    verbs: ClassVar = {
        "bw": "Display bandwidth used by topic",
        "delay": "Display delay of topic from timestamp in header",
        "echo": "Output messages from a topic",
        "find": "Output a list of available topics of a given type",
        "hz": "Print the average receiving rate to screen",
        "info": "Print information about a topic",
        "list": "Output a list of available topics",
        "pub": "Publish a message to a topic",
        "type": "Print a topic's type",
    }

    def add_options(self, parser: ArgumentParser) -> None:
        """Declare the options common to all verbs."""
        parser.add_argument("--include-hidden-topics", action="store_true", help="Consider hidden topics as well")
