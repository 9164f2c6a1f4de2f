"""`ros2 topic type`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2cli.node.strategy import add_arguments as add_graph_arguments

from daidalos.cli.ros2.completion import complete_topics
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.graph import absolute, topics
from daidalos.cli.ros2.graph_view import graph_view
from daidalos.cli.ros2.listings import print_types


class TypeVerb(Verb):
    """Print a topic's type."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        complete_topics(parser.add_argument("topic_name", help="Name of the ROS topic to get type (e.g. '/chatter')"))

    def main(self, *, args: Namespace) -> Status:
        """Print the types; the status is 1 if the topic does not exist."""
        name = absolute(args.topic_name)
        with graph_view(args) as graph:
            known = topics(graph, args.include_hidden_topics)
        return print_types(known, name, "topic")
