"""`ros2 service find`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from daidalos.cli.ros2.completion import complete_types
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.graph import services
from daidalos.cli.ros2.graph_view import graph_view
from daidalos.cli.ros2.listings import add_count_argument, add_hidden_argument, print_names


class FindVerb(Verb):
    """Output a list of available services of a given type."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        complete_types(
            parser.add_argument(
                "service_type",
                help="Name of the ROS service type to filter for (e.g. 'rcl_interfaces/srv/ListParameters')",
            ),
            "srv",
        )
        add_count_argument(parser, "services")
        add_hidden_argument(parser, "services")

    def main(self, *, args: Namespace) -> Status:
        """Print the names of the services of the type, or their number."""
        with graph_view(args) as graph:
            found = [
                name for name, types in services(graph, args.include_hidden_services) if args.service_type in types
            ]
        print_names(found, count=args.count_services)
        return 0
