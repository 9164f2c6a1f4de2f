"""Component containers and their components."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from typing import TYPE_CHECKING, Any

from ros2cli.services import call

from daidalos.cli.ros2.completion import complete, complete_packages
from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.graph import absolute, wait_for_name
from daidalos.common.suggestions import did_you_mean
from daidalos.transport.graph import EndpointKind, Graph

if TYPE_CHECKING:
    from rclpy.node import Node

_SERVICES = "/_container"
_LOADING_S = 120.0
"""Timeout for the start of a component, whose imports may have to be compiled first."""


def add_container_argument(parser: ArgumentParser, **options: Any) -> None:
    """Declare the argument of the container."""

    def names(parsed_args: Namespace, **_: Any) -> list[str]:
        from daidalos.cli.ros2.graph_view import graph_view

        with graph_view(parsed_args) as graph:
            return containers(graph)

    complete(parser.add_argument("container_node_name", help="Container node name", **options), names)


def containers(graph: Graph) -> list[str]:
    """Return the full names of the nodes that are containers, sorted."""
    suffix = f"{_SERVICES}/list_nodes"
    served = {one.name for one in graph.endpoints(EndpointKind.SERVICE) if one.name.endswith(suffix)}
    return sorted(name.removesuffix(suffix) for name in served)


def find_container(graph: Graph, name: str) -> str:
    """Return the full name of a container; CliError if it does not come, see `wait_for_name`."""
    full_name = absolute(name)
    if not wait_for_name(graph, full_name, lambda: containers(graph)):
        raise CliError(f"Unable to find container node '{name}'{did_you_mean(full_name, containers(graph))}")
    return full_name


def loaded(node: Node, container: str) -> list[tuple[int, str]]:
    """Return the components in a container: [(number, full node name)]."""
    from composition_interfaces.srv import ListNodes

    response = call(node, ListNodes, f"{container}{_SERVICES}/list_nodes", ListNodes.Request())
    return sorted(zip(response.unique_ids, response.full_node_names, strict=True))


def add_component_arguments(parser: ArgumentParser) -> None:
    """Declare the arguments of a component and its node."""
    complete_packages(parser.add_argument("package_name", help="Package name where to look for the component plugin"))
    complete(
        parser.add_argument("plugin_name", help="Type name of the component to be loaded"),
        lambda parsed_args, **_: _plugins(parsed_args.package_name),
    )
    parser.add_argument("-n", "--node-name", default="", help="Component node name")
    parser.add_argument("--node-namespace", default="", help="Component node namespace")
    parser.add_argument("--log-level", default="", help="Component node log level")
    parser.add_argument(
        "-r", "--remap-rule", action="append", default=[], help="Component node remapping rules, in the 'from:=to' form"
    )
    parser.add_argument(
        "-p", "--parameter", action="append", default=[], help="Component node parameters, in the 'name:=value' form"
    )
    parser.add_argument(
        "-e", "--extra-argument", action="append", default=[], help="Extra arguments for the container, in the "
        "'name:=value' form"
    )  # fmt: skip


def _plugins(package: str) -> list[str]:
    from daidalos.nodes.extensions import components

    return components(package)


def load(node: Node, container: str, args: Namespace) -> tuple[int, str]:
    """Load a component into a container; return its number and full node name.

    Raises
    ------
    CliError
        When the arguments cannot be understood or the container refuses.
    """
    from composition_interfaces.srv import LoadNode

    request = LoadNode.Request(
        package_name=args.package_name,
        plugin_name=args.plugin_name,
        node_name=args.node_name,
        node_namespace=args.node_namespace,
        log_level=_log_level(args.log_level),
        remap_rules=args.remap_rule,
        parameters=[_parameter(text) for text in args.parameter],
        extra_arguments=[_parameter(text) for text in args.extra_argument],
    )
    response = call(node, LoadNode, f"{container}{_SERVICES}/load_node", request, answer_s=_LOADING_S)
    if not response.success:
        raise CliError(f"Failed to load component: {response.error_message}")
    return response.unique_id, response.full_node_name


def unload(node: Node, container: str, number: int) -> str:
    """Unload a component from a container; return the reason of a failure, else an empty text."""
    from composition_interfaces.srv import UnloadNode

    request = UnloadNode.Request(unique_id=number)
    response = call(node, UnloadNode, f"{container}{_SERVICES}/unload_node", request)
    return "" if response.success else response.error_message


def _log_level(name: str) -> int:
    levels = {"": 0, "DEBUG": 10, "INFO": 20, "WARN": 30, "ERROR": 40, "FATAL": 50}
    try:
        return levels[name.upper()]
    except KeyError:
        raise CliError(f"'{name}' is not a log level: use one of {', '.join(filter(None, levels))}") from None


def _parameter(text: str) -> Any:
    from rcl_interfaces.msg import Parameter
    from rclpy.parameter import get_parameter_value

    name, separator, value = text.partition(":=")
    if not separator or not name:
        raise CliError(f"'{text}' is not in the 'name:=value' form")
    return Parameter(name=name, value=get_parameter_value(value))
