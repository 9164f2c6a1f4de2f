"""`ros2 action find`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2cli.node.strategy import add_arguments as add_graph_arguments

from daidalos.cli.ros2.completion import complete_types
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.graph import all_actions
from daidalos.cli.ros2.graph_view import graph_view
from daidalos.cli.ros2.listings import add_count_argument, print_names


class FindVerb(Verb):
    """Find actions from type."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        complete_types(
            parser.add_argument(
                "action_type",
                help="Name of the ROS action type to filter for (e.g. 'example_interfaces/action/Fibonacci')",
            ),
            "action",
        )
        add_count_argument(parser, "actions")

    def main(self, *, args: Namespace) -> Status:
        """Print the names of the actions of the type, or their number."""
        with graph_view(args) as graph:
            found = [name for name, types in all_actions(graph) if args.action_type in types]
        print_names(found, count=args.count_actions)
        return 0
