"""`ros2 param load`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2cli.node.direct import direct_node
from ros2cli.node.strategy import add_arguments as add_graph_arguments
from ros2param.api import load_parameter_file

from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.parameters import add_node_arguments, add_timeout_argument, find_node


class LoadVerb(Verb):
    """Load parameter file for a node."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        add_node_arguments(parser)
        parser.add_argument("parameter_file", help="Parameter file")
        parser.add_argument(
            "--no-use-wildcard",
            action="store_true",
            help="Do not load parameters in the '/**' namespace into the node",
        )
        add_timeout_argument(parser)

    def main(self, *, args: Namespace) -> Status:
        """Set the parameters of the file, and print the result of each."""
        with direct_node(args) as node:
            name = find_node(node, args)
            load_parameter_file(
                node=node, node_name=name, parameter_file=args.parameter_file, use_wildcard=not args.no_use_wildcard
            )
        return 0
