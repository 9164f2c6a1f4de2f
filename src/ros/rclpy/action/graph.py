"""Actions in the graph."""

from __future__ import annotations

from typing import TYPE_CHECKING

from daidalos.transport.graph import EndpointInfo, EndpointKind

if TYPE_CHECKING:
    from rclpy.node import Node

_FEEDBACK = "/_action/feedback"
_MESSAGE = "_FeedbackMessage"


def get_action_client_names_and_types_by_node(
    node: Node, remote_node_name: str, remote_node_namespace: str
) -> list[tuple[str, list[str]]]:
    """Return the actions that a node calls: [(name, [types])].

    Raises
    ------
    NodeNameNonExistentError
        When the node is not there.
    """
    return _by_node(node, remote_node_name, remote_node_namespace, EndpointKind.SUBSCRIPTION)


def get_action_server_names_and_types_by_node(
    node: Node, remote_node_name: str, remote_node_namespace: str
) -> list[tuple[str, list[str]]]:
    """Return the actions that a node serves: [(name, [types])].

    Raises
    ------
    NodeNameNonExistentError
        When the node is not there.
    """
    return _by_node(node, remote_node_name, remote_node_namespace, EndpointKind.PUBLISHER)


def get_action_names_and_types(node: Node) -> list[tuple[str, list[str]]]:
    """Return every action: [(name, [types])]."""
    with node.handle as handle:
        return _actions(handle.graph.endpoints(EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION))


def _by_node(node: Node, name: str, namespace: str, kind: EndpointKind) -> list[tuple[str, list[str]]]:
    with node.handle as handle:
        found = handle.find_node(name, namespace)
        return _actions(handle.graph.endpoints_of(found, kind))


def _actions(endpoints: list[EndpointInfo]) -> list[tuple[str, list[str]]]:
    """Return the actions behind feedback topics."""
    found: dict[str, set[str]] = {}
    for endpoint in endpoints:
        if endpoint.name.endswith(_FEEDBACK) and endpoint.type_name.endswith(_MESSAGE):
            name = endpoint.name.removesuffix(_FEEDBACK)
            found.setdefault(name, set()).add(endpoint.type_name.removesuffix(_MESSAGE))
    return [(name, sorted(found[name])) for name in sorted(found)]
