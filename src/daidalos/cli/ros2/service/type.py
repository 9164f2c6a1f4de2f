"""`ros2 service type`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from daidalos.cli.ros2.completion import complete_services
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.graph import absolute, services
from daidalos.cli.ros2.graph_view import graph_view
from daidalos.cli.ros2.listings import print_types


class TypeVerb(Verb):
    """Output a service's type."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        complete_services(
            parser.add_argument(
                "service_name", help="Name of the ROS service to get type (e.g. '/talker/list_parameters')"
            )
        )

    def main(self, *, args: Namespace) -> Status:
        """Print the types; the status is 1 if the service does not exist."""
        name = absolute(args.service_name)
        with graph_view(args) as graph:
            known = services(graph)
        return print_types(known, name, "service")
