"""`ros2 topic find`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2cli.node.strategy import add_arguments as add_graph_arguments

from daidalos.cli.ros2.completion import complete_types
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.graph import topics
from daidalos.cli.ros2.graph_view import graph_view
from daidalos.cli.ros2.listings import add_count_argument, add_hidden_argument, print_names


class FindVerb(Verb):
    """Output a list of available topics of a given type."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        complete_types(
            parser.add_argument(
                "topic_type", help="Name of the ROS topic type to filter for (e.g. 'std_msgs/msg/String')"
            ),
            "msg",
        )
        add_count_argument(parser, "topics")
        add_hidden_argument(parser, "topics")

    def main(self, *, args: Namespace) -> Status:
        """Print the names of the topics of the type, or their number."""
        with graph_view(args) as graph:
            found = [name for name, types in topics(graph, args.include_hidden_topics) if args.topic_type in types]
        print_names(found, count=args.count_topics)
        return 0
