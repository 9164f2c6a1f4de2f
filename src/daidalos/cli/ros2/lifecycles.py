"""Managed nodes, their states and their transitions."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from typing import TYPE_CHECKING, Any

from ros2cli.services import call

from daidalos.cli.ros2.completion import complete
from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.graph import absolute, nodes, wait_for_name
from daidalos.common.suggestions import did_you_mean
from daidalos.transport.graph import EndpointKind, Graph

if TYPE_CHECKING:
    from rclpy.node import Node

_TRANSITION_S = 60.0
"""Timeout of a transition, in which nodes may load maps and open devices."""


def add_node_arguments(parser: ArgumentParser, **options: Any) -> None:
    """Declare the arguments of the managed node."""

    def names(parsed_args: Namespace, **_: Any) -> list[str]:
        from daidalos.cli.ros2.graph_view import graph_view

        with graph_view(parsed_args) as graph:
            return managed_nodes(graph, getattr(parsed_args, "include_hidden_nodes", False))

    complete(parser.add_argument("node_name", help="Name of the ROS node", **options), names)
    parser.add_argument("--include-hidden-nodes", action="store_true", help="Consider hidden nodes as well")


def managed_nodes(graph: Graph, include_hidden: bool = False) -> list[str]:
    """Return the full names of the nodes that have a lifecycle, sorted."""
    return [
        node.full_name
        for node in nodes(graph, include_hidden)
        if any(
            endpoint.name == f"{node.full_name}/get_state" and endpoint.type_name == "lifecycle_msgs/srv/GetState"
            for endpoint in graph.endpoints_of(node, EndpointKind.SERVICE)
        )
    ]


def find_managed(graph: Graph, args: Namespace, limit_s: float | None = None) -> str:
    """Return the full name of a managed node; CliError if it does not come, see `wait_for_name`."""
    name = absolute(args.node_name)

    def known() -> list[str]:
        return managed_nodes(graph, args.include_hidden_nodes)

    if not wait_for_name(graph, name, known, limit_s):
        raise CliError(f"Node not found{did_you_mean(name, known())}")
    return name


def state(node: Node, name: str) -> Any:
    """Return a node's state: `lifecycle_msgs/msg/State`."""
    from lifecycle_msgs.srv import GetState

    return call(node, GetState, f"{name}/get_state", GetState.Request()).current_state


def transitions(node: Node, name: str, every: bool = False) -> list[Any]:
    """Return the available transitions of a node, or all of its state machine (`TransitionDescription`)."""
    from lifecycle_msgs.srv import GetAvailableTransitions

    service = "get_transition_graph" if every else "get_available_transitions"
    response = call(node, GetAvailableTransitions, f"{name}/{service}", GetAvailableTransitions.Request())
    return list(response.available_transitions)


def change_state(node: Node, name: str, transition: Any) -> bool:
    """Trigger a transition (`lifecycle_msgs/msg/Transition`) of a node; return whether it succeeded."""
    from lifecycle_msgs.srv import ChangeState

    request = ChangeState.Request(transition=transition)
    return bool(call(node, ChangeState, f"{name}/change_state", request, answer_s=_TRANSITION_S).success)
