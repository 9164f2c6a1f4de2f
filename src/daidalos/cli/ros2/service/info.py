"""`ros2 service info`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2cli.node.strategy import add_arguments as add_graph_arguments

from daidalos.cli.ros2.completion import complete_services
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.graph import absolute, services, types_of
from daidalos.cli.ros2.graph_view import graph_view
from daidalos.common.suggestions import did_you_mean
from daidalos.transport.graph import EndpointKind


class InfoVerb(Verb):
    """Print information about a service."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        complete_services(
            parser.add_argument("service_name", help="Name of the ROS service to get info (e.g. '/add_two_ints')")
        )

    def main(self, *, args: Namespace) -> Status:
        """Print the type and the numbers of clients and servers."""
        name = absolute(args.service_name)
        with graph_view(args) as graph:
            known = services(graph)
            clients = graph.endpoints(EndpointKind.CLIENT, name=name)
            servers = graph.endpoints(EndpointKind.SERVICE, name=name)
        types = types_of(known, name)
        if not types:
            return f"Unknown service '{args.service_name}'{did_you_mean(name, (other for other, _ in known))}"
        print(f"Type: {types[0] if len(types) == 1 else types}")
        print(f"Clients count: {len(clients)}")
        print(f"Services count: {len(servers)}")
        return 0
