"""`ros2 service call`."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from typing import TYPE_CHECKING, Any

from ros2cli.node.direct import direct_node
from ros2topic.api import positive_float

from daidalos.cli.ros2.completion import complete_services, complete_types, complete_values
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.graph import check_type, types_of
from daidalos.cli.ros2.interfaces import fill, parse_values, service_class
from daidalos.common.suggestions import hint_line, near_or_all
from daidalos.transport.graph import EndpointKind, names_and_types

if TYPE_CHECKING:
    from rclpy.client import Client
    from rclpy.node import Node
    from ros2cli.graph import NamesAndTypes


class CallVerb(Verb):
    """Call a service."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        complete_services(
            parser.add_argument("service_name", help="Name of the ROS service to call to (e.g. '/add_two_ints')")
        )
        complete_types(
            parser.add_argument("service_type", help="Type of the ROS service (e.g. 'std_srvs/srv/Empty')"),
            "srv",
            "service_name",
        )
        source = parser.add_mutually_exclusive_group()
        complete_values(
            source.add_argument(
                "values",
                nargs="?",
                default="{}",
                help="Values to fill the service request with in YAML format (e.g. '{a: 1, b: 2}'), otherwise the "
                "service request will be published with default values",
            ),
            "service_type",
        )
        source.add_argument("--stdin", action="store_true", help="Read values from standard input")
        parser.add_argument(
            "-r", "--rate", metavar="N", type=positive_float, help="Repeat the call at a specific rate in Hz"
        )

    def main(self, *, args: Namespace) -> Status:
        """Call the service once, or at a rate until Ctrl-C."""
        service_type = service_class(args.service_type)
        request = service_type.Request()
        stampers = fill(request, parse_values(sys.stdin.read() if args.stdin else args.values))
        with direct_node(args) as node:
            client = node.create_client(service_type, args.service_name)
            _wait(node, client, service_type._TYPE_NAME)
            while True:
                now = node.get_clock().now().to_msg() if stampers else None
                for stamp in stampers:
                    stamp(now)
                _call(client, request)
                if args.rate is None:
                    return 0
                node.handle.graph.wait_for(lambda: False, 1.0 / args.rate)


def _wait(node: Node, client: Client, wanted: str) -> None:
    """Wait for the service, and print what there is instead; CliError if it has another type."""
    graph, name = node.handle.graph, client.service_name

    def served() -> NamesAndTypes:
        return names_and_types(graph.endpoints(EndpointKind.SERVICE))

    if client.service_is_ready():
        return
    check_type(served(), name, wanted)
    print("waiting for service to become available...", flush=True)
    same_type = [other for other, types in served() if wanted in types]
    known = [other for other, _ in served()]
    sys.stderr.write(hint_line(name, known) or near_or_all(name, same_type, f"services of type {wanted}"))
    sys.stderr.flush()
    graph.wait_for(lambda: bool(types_of(served(), name)))
    check_type(served(), name, wanted)
    client.wait_for_service()


def _call(client: Client, request: Any) -> None:
    print(f"requester: making request: {request!r}\n")
    response = client.call(request)
    print(f"response:\n{response!r}\n")
