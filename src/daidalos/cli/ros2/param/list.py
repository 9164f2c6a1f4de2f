"""`ros2 param list`."""

from __future__ import annotations

import re
from argparse import ArgumentParser, Namespace
from typing import TYPE_CHECKING

from ros2cli.node.direct import direct_node
from ros2cli.node.strategy import add_arguments as add_graph_arguments
from ros2param.api import TYPE_NAMES

from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.graph import nodes
from daidalos.cli.ros2.parameters import add_node_arguments, describe_parameters, find_node, list_parameters
from daidalos.transport.graph import EndpointKind

if TYPE_CHECKING:
    from rclpy.node import Node


class ListVerb(Verb):
    """Output a list of available parameters."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        add_node_arguments(parser, nargs="?")
        parser.add_argument(
            "--filter",
            nargs=1,
            help="Only parameters matching the regex expression will be showed. Supports `re` regex syntax.",
        )
        parser.add_argument(
            "--param-prefixes", nargs="+", default=[], help="Only list parameters with the provided prefixes"
        )
        parser.add_argument("--param-type", action="store_true", help="Print parameter types with parameter names")

    def main(self, *, args: Namespace) -> Status:
        """Print the parameters of one node, or of every node."""
        try:
            pattern = re.compile(args.filter[0] if args.filter else "")
        except re.error as error:
            raise CliError(f"The filter '{args.filter[0]}' is not a regular expression: {error}") from None
        with direct_node(args) as node:
            names = [find_node(node, args)] if args.node_name else _with_parameters(node, args.include_hidden_nodes)
            for name in names:
                found = [one for one in list_parameters(node, name, args.param_prefixes) if pattern.match(one)]
                if not args.node_name and found:
                    print(f"{name}:")
                for line in _with_types(node, name, found) if args.param_type else found:
                    print(f"  {line}")
        return 0


def _with_parameters(node: Node, include_hidden: bool) -> list[str]:
    """Return the full names of the nodes with parameter services."""
    graph = node.handle.graph
    names = dict.fromkeys(one.full_name for one in nodes(graph, include_hidden))
    return [name for name in names if graph.endpoints(EndpointKind.SERVICE, name=f"{name}/list_parameters")]


def _with_types(node: Node, node_name: str, names: list[str]) -> list[str]:
    types = {one.name: one.type for one in describe_parameters(node, node_name, names)}
    return [f"{name} (type: {TYPE_NAMES[types[name]]})" for name in names]
