"""Nodes in the graph, and what they publish, listen to, serve and call."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

from ros2cli.graph import NameCompleter, visible


class NodeName(NamedTuple):
    """A node: its name, its namespace, and both joined."""

    name: str
    namespace: str
    full_name: str


class TopicInfo(NamedTuple):
    """A topic, service or action with its types."""

    name: str
    types: list[str]


_HIDDEN_PREFIX = "_"

INFO_NONUNIQUE_WARNING_TEMPLATE = (
    'There are {num_nodes} nodes in the graph with the exact name "{node_name}". '
    "You are seeing information about only one of them."
)


def get_node_names(*, node: Any, include_hidden_nodes: bool = False) -> list[NodeName]:
    """Return the nodes in the graph.

    Parameters
    ----------
    node
        Who asks: an rclpy node or a `NodeStrategy`.
    include_hidden_nodes
        Whether those whose name begins with an underscore are among them.
    """
    return [
        NodeName(name, namespace, f"{namespace.rstrip('/')}/{name}")
        for name, namespace in node.get_node_names_and_namespaces()
        if include_hidden_nodes or not name.startswith(_HIDDEN_PREFIX)
    ]


def get_absolute_node_name(node_name: str) -> str | None:
    """Return a name with a slash before it; None where there is no name."""
    if not node_name:
        return None
    return node_name if node_name.startswith("/") else f"/{node_name}"


def parse_node_name(node_name: str) -> NodeName:
    """Return the parts of a name such as ``/robot/driver``."""
    full_name = node_name if node_name.startswith("/") else f"/{node_name}"
    namespace, _, name = full_name.rpartition("/")
    return NodeName(name, namespace or "/", full_name)


def has_duplicates(values: Iterable[Any]) -> bool:
    """Return whether a value is there more than once."""
    listed = list(values)
    return len(set(listed)) < len(listed)


def wait_for_node(node: Any, node_name: str, include_hidden_nodes: bool = False, timeout: float = 1.0) -> bool:
    """Wait until a node is in the graph; return whether it is.

    Parameters
    ----------
    node
        Who asks.
    node_name
        The full name of the node.
    include_hidden_nodes
        Whether it may be a hidden node.
    timeout
        For how long [s].
    """
    wanted = get_absolute_node_name(node_name) or ""

    def is_there() -> bool:
        found = get_node_names(node=node, include_hidden_nodes=include_hidden_nodes)
        return wanted in (one.full_name for one in found)

    return bool(node.handle.graph.wait_for(is_there, timeout))


def get_topics(
    remote_node_name: str,
    func: Callable[[str, str], Iterable[tuple[str, list[str]]]],
    *,
    include_hidden_topics: bool = False,
) -> list[TopicInfo]:
    """Return what a function returns about a node.

    Parameters
    ----------
    remote_node_name
        The node.
    func
        Takes the node's name and its namespace.
    include_hidden_topics
        Whether what has a part that begins with an underscore is among it.
    """
    wanted = parse_node_name(remote_node_name)
    found = visible(list(func(wanted.name, wanted.namespace)), include_hidden_topics)
    return [TopicInfo(name, types) for name, types in found]


def get_publisher_info(*, node: Any, remote_node_name: str, include_hidden: bool = False) -> list[TopicInfo]:
    """Return the topics that a node publishes; see `get_topics`."""
    return get_topics(
        remote_node_name, node.get_publisher_names_and_types_by_node, include_hidden_topics=include_hidden
    )


def get_subscriber_info(*, node: Any, remote_node_name: str, include_hidden: bool = False) -> list[TopicInfo]:
    """Return the topics that a node listens to; see `get_topics`."""
    return get_topics(
        remote_node_name, node.get_subscriber_names_and_types_by_node, include_hidden_topics=include_hidden
    )


def get_service_server_info(*, node: Any, remote_node_name: str, include_hidden: bool = False) -> list[TopicInfo]:
    """Return the services that a node serves; see `get_topics`."""
    return get_topics(remote_node_name, node.get_service_names_and_types_by_node, include_hidden_topics=include_hidden)


def get_service_client_info(*, node: Any, remote_node_name: str, include_hidden: bool = False) -> list[TopicInfo]:
    """Return the services that a node calls; see `get_topics`."""
    return get_topics(remote_node_name, node.get_client_names_and_types_by_node, include_hidden_topics=include_hidden)


def get_action_server_info(*, node: Any, remote_node_name: str, include_hidden: bool = False) -> list[TopicInfo]:
    """Return the actions that a node serves; see `get_topics`."""
    return get_topics(
        remote_node_name,
        lambda name, namespace: node.get_action_server_names_and_types_by_node(name, namespace),
        include_hidden_topics=include_hidden,
    )


def get_action_client_info(*, node: Any, remote_node_name: str, include_hidden: bool = False) -> list[TopicInfo]:
    """Return the actions that a node calls; see `get_topics`."""
    return get_topics(
        remote_node_name,
        lambda name, namespace: node.get_action_client_names_and_types_by_node(name, namespace),
        include_hidden_topics=include_hidden,
    )


class NodeNameCompleter(NameCompleter):
    """Completer of the full names of the nodes that an argument may be.

    Parameters
    ----------
    include_hidden_nodes_key
        The argument that says whether hidden nodes are among them.
    """

    def __init__(self, *, include_hidden_nodes_key: str | None = None) -> None:
        super().__init__(_full_names, include_hidden_nodes_key)


def _full_names(node: Any, include_hidden: bool) -> list[str]:
    return [one.full_name for one in get_node_names(node=node, include_hidden_nodes=include_hidden)]
