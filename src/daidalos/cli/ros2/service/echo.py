"""`ros2 service echo`."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from typing import TYPE_CHECKING, Any

from ros2cli.node.direct import direct_node
from ros2cli.node.strategy import add_arguments as add_graph_arguments
from ros2cli.qos import add_qos_arguments

from daidalos.cli.ros2.completion import complete_services, complete_types
from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.graph import services, types_of
from daidalos.cli.ros2.interfaces import service_class
from daidalos.cli.ros2.topic.echo import add_length_arguments, csv_text, yaml_text
from daidalos.cli.ros2.topics import spin, subscribe
from daidalos.common.suggestions import did_you_mean
from daidalos.transport.graph import EndpointKind

if TYPE_CHECKING:
    from rclpy.node import Node

_EVENTS = "/_service_event"
_EVENT_TYPES = ("REQUEST_SENT", "REQUEST_RECEIVED", "RESPONSE_SENT", "RESPONSE_RECEIVED")


class EchoVerb(Verb):
    """Echo a service."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        complete_services(
            parser.add_argument("service_name", help="Name of the ROS service to echo from (e.g. '/add_two_ints')")
        )
        complete_types(
            parser.add_argument(
                "service_type", nargs="?", help="Type of the ROS service (e.g. 'example_interfaces/srv/AddTwoInts')"
            ),
            "srv",
            "service_name",
        )
        add_qos_arguments(parser, "subscribe", "services_default")
        parser.add_argument(
            "--csv", action="store_true", help="Output all recursive fields separated by commas (e.g. for plotting)"
        )
        add_length_arguments(parser)

    def main(self, *, args: Namespace) -> Status:
        """Print the events of clients and servers until Ctrl-C."""
        with direct_node(args) as node:
            name = node.resolve_service_name(args.service_name)
            service_type = service_class(args.service_type or _type_of(node, args, name))
            if not node.handle.graph.endpoints(EndpointKind.PUBLISHER, name=name + _EVENTS):
                print(
                    f"No events of calls of '{name}' are published: configure introspection in its client or server",
                    file=sys.stderr,
                )
            subscribe(
                node, args, name + _EVENTS, service_type.Event, lambda event: sys.stdout.write(_text(args, event))
            )
            spin(node)
        return 0


def _type_of(node: Node, args: Namespace, name: str) -> str:
    known = services(node.handle.graph)
    types = types_of(known, name)
    if not types:
        hint = did_you_mean(name, (other for other, _ in known))
        raise CliError(f"Could not determine the type for the passed service{hint}")
    if len(types) > 1:
        raise CliError(
            f"Cannot echo service '{args.service_name}', as it contains more than one type: [{', '.join(types)}]"
        )
    return types[0]


def _text(args: Namespace, event: Any) -> str:
    if args.csv:
        return csv_text(args, [event])
    text = yaml_text(args, [event])
    number = event.info.event_type
    kind = _EVENT_TYPES[number] if number < len(_EVENT_TYPES) else str(number)
    return text.replace(f"event_type: {number}\n", f"event_type: {kind}\n", 1)
