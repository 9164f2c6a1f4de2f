"""`ros2 service list`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2cli.node.strategy import add_arguments as add_graph_arguments

from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.graph import services
from daidalos.cli.ros2.graph_view import graph_view
from daidalos.cli.ros2.listings import add_count_argument, add_hidden_argument, print_found


class ListVerb(Verb):
    """Output a list of available services."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        parser.add_argument("-t", "--show-types", action="store_true", help="Additionally show the service type")
        add_count_argument(parser, "services")
        add_hidden_argument(parser, "services")

    def main(self, *, args: Namespace) -> Status:
        """Print the names, with types or as a number on request."""
        with graph_view(args) as graph:
            found = services(graph, args.include_hidden_services)
        print_found(found, show_types=args.show_types, count=args.count_services)
        return 0
