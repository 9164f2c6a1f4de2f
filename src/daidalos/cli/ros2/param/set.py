"""`ros2 param set`."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace

from ros2cli.node.direct import direct_node
from ros2cli.node.strategy import add_arguments as add_graph_arguments
from ros2param.api import report

from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.interfaces import parse_yaml
from daidalos.cli.ros2.parameters import (
    add_node_arguments,
    add_timeout_argument,
    complete_parameters,
    find_node,
    set_parameters,
    suggest,
)


class SetVerb(Verb):
    """Set parameter."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        add_node_arguments(parser)
        complete_parameters(parser.add_argument("parameter_name", help="Name of the parameter"))
        parser.add_argument("value", help="Value of the parameter")
        add_timeout_argument(parser)

    def main(self, *, args: Namespace) -> Status:
        """Set the parameter, and print the result."""
        from rcl_interfaces.msg import Parameter
        from rclpy.parameter import get_parameter_value

        parameter = Parameter(name=args.parameter_name, value=get_parameter_value(args.value))
        with direct_node(args) as node:
            name = find_node(node, args)
            result = set_parameters(node, name, [parameter])[0]
            if not report(result, "Set parameter successful", "Setting parameter failed"):
                suggest(node, name, args.parameter_name)
                sys.stderr.write(_yaml_hint(args.value))
        return 0


def _yaml_hint(value: str) -> str:
    """Return a hint about a value that starts like YAML but is not valid; empty for other texts."""
    try:
        if value.lstrip().startswith(("[", "{")):
            parse_yaml(value)
    except CliError as error:
        return f"{error}\n"
    return ""
