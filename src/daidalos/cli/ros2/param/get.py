"""`ros2 param get`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2cli.node.direct import direct_node
from ros2cli.node.strategy import add_arguments as add_graph_arguments
from ros2param.api import call_get_parameters

from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.parameters import (
    add_node_arguments,
    add_timeout_argument,
    complete_parameters,
    find_node,
    suggest,
)

_LABELS = (
    "Parameter not set.", "Boolean value is:", "Integer value is:", "Double value is:", "String value is:",
    "Byte values are:", "Boolean values are:", "Integer values are:", "Double values are:", "String values are:",
)  # fmt: skip


class GetVerb(Verb):
    """Get parameter."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        add_node_arguments(parser)
        complete_parameters(parser.add_argument("parameter_name", help="Name of the parameter"))
        parser.add_argument("--hide-type", action="store_true", help="Hide the type information")
        add_timeout_argument(parser)

    def main(self, *, args: Namespace) -> Status:
        """Print the value."""
        from rclpy.parameter import parameter_value_to_python

        with direct_node(args) as node:
            name = find_node(node, args)
            answer = call_get_parameters(node=node, node_name=name, parameter_names=[args.parameter_name])
            values = answer.values
            value = parameter_value_to_python(values[0]) if values else None
            if value is None:
                suggest(node, name, args.parameter_name)
                if not values:
                    raise CliError("Parameter not set")
                print(_LABELS[0])
                return 0
        print(value if args.hide_type else f"{_LABELS[values[0].type]} {value}")
        return 0
