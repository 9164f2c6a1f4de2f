"""`ros2 node list`."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace

from ros2cli.node.strategy import add_arguments as add_graph_arguments

from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.graph import duplicate_names, nodes
from daidalos.cli.ros2.graph_view import graph_view
from daidalos.cli.ros2.listings import add_count_argument


class ListVerb(Verb):
    """Output a list of available nodes."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        parser.add_argument("-a", "--all", action="store_true", help="Display all nodes even hidden ones")
        add_count_argument(parser, "nodes")

    def main(self, *, args: Namespace) -> Status:
        """Print the full names, or their number."""
        with graph_view(args) as graph:
            found = nodes(graph, include_hidden=args.all)
        if args.count_nodes:
            print(len(found))
            return 0
        if duplicate_names(found):
            print(
                "WARNING: Be aware that there are nodes in the graph that share an exact name, "
                "which can have unintended side effects.",
                file=sys.stderr,
            )
        for node in found:
            print(node.full_name)
        return 0
