"""`ros2 lifecycle nodes`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2cli.node.strategy import add_arguments as add_graph_arguments

from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.graph_view import graph_view
from daidalos.cli.ros2.lifecycles import managed_nodes
from daidalos.cli.ros2.listings import add_count_argument, print_names


class NodesVerb(Verb):
    """Output a list of nodes with lifecycle."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        parser.add_argument("-a", "--all", action="store_true", help="Display all nodes even hidden ones")
        add_count_argument(parser, "nodes")

    def main(self, *, args: Namespace) -> Status:
        """Print the full names, or their number."""
        with graph_view(args) as graph:
            found = managed_nodes(graph, args.all)
        print_names(found, count=args.count_nodes)
        return 0
