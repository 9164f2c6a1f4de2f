"""`ros2 param delete`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2cli.node.direct import direct_node
from ros2cli.node.strategy import add_arguments as add_graph_arguments
from ros2param.api import report

from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.parameters import (
    add_node_arguments,
    add_timeout_argument,
    complete_parameters,
    find_node,
    set_parameters,
    suggest,
)


class DeleteVerb(Verb):
    """Delete parameter."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        add_node_arguments(parser)
        complete_parameters(parser.add_argument("parameter_name", help="Name of the parameter"))
        add_timeout_argument(parser)

    def main(self, *, args: Namespace) -> Status:
        """Unset the parameter, and print the result."""
        from rcl_interfaces.msg import Parameter

        with direct_node(args) as node:
            name = find_node(node, args)
            result = set_parameters(node, name, [Parameter(name=args.parameter_name)])[0]
            if not report(result, "Deleted parameter successfully", "Deleting parameter failed"):
                suggest(node, name, args.parameter_name)
        return 0
