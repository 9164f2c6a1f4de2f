"""Parameters of other nodes."""

from __future__ import annotations

import sys
from argparse import Action, ArgumentParser, Namespace
from typing import TYPE_CHECKING, Any

from ros2cli.node.direct import direct_node
from ros2param.api import call_describe_parameters, call_list_parameters, call_set_parameters

from daidalos.cli.ros2.completion import complete, complete_nodes
from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.graph import absolute, nodes, wait_for_name
from daidalos.common.suggestions import did_you_mean, hint_line

if TYPE_CHECKING:
    from rclpy.node import Node


def add_node_arguments(parser: ArgumentParser, **options: Any) -> None:
    """Declare the argument of the node."""
    complete_nodes(parser.add_argument("node_name", help="Name of the ROS node", **options))
    parser.add_argument("--include-hidden-nodes", action="store_true", help="Consider hidden nodes as well")


def complete_parameters(action: Action, node_key: str = "node_name") -> Action:
    """Return the parameters of the node that another argument names; completer."""

    def names(parsed_args: Namespace, **_: Any) -> list[str]:
        with direct_node(parsed_args) as node:
            return list_parameters(node, absolute(getattr(parsed_args, node_key)))

    return complete(action, names)


def add_timeout_argument(parser: ArgumentParser) -> None:
    """Declare the argument of the discovery timeout."""
    parser.add_argument("--timeout", metavar="N", type=float, help="Wait for N seconds until node becomes available")


def find_node(node: Node, args: Namespace) -> str:
    """Return the full name of a node once it is discovered; CliError if it is not."""
    name = absolute(args.node_name)
    graph = node.handle.graph

    def known() -> list[str]:
        return [other.full_name for other in nodes(graph, args.include_hidden_nodes)]

    if not wait_for_name(graph, name, known, getattr(args, "timeout", None)):
        raise CliError(f"Node not found{did_you_mean(name, known())}")
    return name


def list_parameters(node: Node, node_name: str, prefixes: list[str] | None = None) -> list[str]:
    """Return the names of a node's parameters, sorted."""
    return sorted(call_list_parameters(node=node, node_name=node_name, prefixes=prefixes).result.names)


def set_parameters(node: Node, node_name: str, parameters: list[Any]) -> list[Any]:
    """Set parameters (`rcl_interfaces/msg/Parameter`); return the results (`SetParametersResult`)."""
    return list(call_set_parameters(node=node, node_name=node_name, parameters=parameters).results)


def describe_parameters(node: Node, node_name: str, names: list[str]) -> list[Any]:
    """Return the descriptions of parameters: `rcl_interfaces/msg/ParameterDescriptor`."""
    return list(call_describe_parameters(node=node, node_name=node_name, parameter_names=names).descriptors)


def suggest(node: Node, node_name: str, parameter: str) -> None:
    """Print parameters with names similar to an unknown one, if any, on standard error."""
    known = list_parameters(node, node_name)
    if parameter not in known:
        sys.stderr.write(hint_line(parameter, known))
