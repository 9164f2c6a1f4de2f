"""`ros2 action list`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2cli.node.strategy import add_arguments as add_graph_arguments

from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.graph import all_actions
from daidalos.cli.ros2.graph_view import graph_view
from daidalos.cli.ros2.listings import add_count_argument, print_found


class ListVerb(Verb):
    """Output a list of action names."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        parser.add_argument("-t", "--show-types", action="store_true", help="Additionally show the action type")
        add_count_argument(parser, "actions")

    def main(self, *, args: Namespace) -> Status:
        """Print the names, with types or as a number on request."""
        with graph_view(args) as graph:
            found = all_actions(graph)
        print_found(found, show_types=args.show_types, count=args.count_actions)
        return 0
