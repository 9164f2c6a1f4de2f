"""Nodes, topics, services and actions of the graph; hidden ones are left out unless told otherwise."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from rclpy.node import Node

from rosapi.glob_helper import any_match, filter_globs

Names = list[tuple[str, list[str]]]
_node: Node | None = None
_ACTION_TOPICS = ("/_action/feedback", "/_action/status")


def init(node: Node) -> None:
    """Set the node that asks the graph."""
    global _node
    _node = node


def _asker() -> Node:
    if _node is None:
        raise RuntimeError("call rosapi.proxy.init first, with the node that asks the graph")
    return _node


def _is_hidden(name: str) -> bool:
    return any(part.startswith("_") for part in name.split("/"))


def _seen(found: Names, include_hidden: bool) -> Names:
    return [(name, types) for name, types in found if include_hidden or not _is_hidden(name)]


def _topics(include_hidden: bool) -> Names:
    return _seen(_asker().get_topic_names_and_types(), include_hidden)


def _services(include_hidden: bool) -> Names:
    return _seen(_asker().get_service_names_and_types(), include_hidden)


def _allowed(found: Names, globs: Sequence[str] | None) -> tuple[list[str], list[str]]:
    kept = [(name, types[0]) for name, types in found if any_match(name, globs)]
    return [name for name, _ in kept], [kind for _, kind in kept]


def _of_type(found: Names, kind: str, globs: Sequence[str] | None) -> list[str]:
    return filter_globs(globs, [name for name, types in found if kind in types])


def get_topics_and_types(
    topics_glob: Sequence[str] | None, include_hidden: bool = False
) -> tuple[list[str], list[str]]:
    """Return the topics, and their types in the same order."""
    return _allowed(_topics(include_hidden), topics_glob)


def get_topics(topics_glob: Sequence[str] | None, include_hidden: bool = False) -> list[str]:
    """Return the topics."""
    return get_topics_and_types(topics_glob, include_hidden)[0]


def get_topics_types(topics: Sequence[str], topics_glob: Sequence[str] | None) -> list[str]:
    """Return the types of topics, an empty text for one that there is not."""
    known = dict(zip(*get_topics_and_types(topics_glob, include_hidden=True), strict=True))
    return [known.get(topic, "") for topic in topics]


def get_topics_for_type(topic_type: str, topics_glob: Sequence[str] | None, include_hidden: bool = False) -> list[str]:
    """Return the topics of a type."""
    return _of_type(_topics(include_hidden), topic_type, topics_glob)


def get_services(services_glob: Sequence[str] | None, include_hidden: bool = False) -> list[str]:
    """Return the services."""
    return get_services_and_types(services_glob, include_hidden)[0]


def get_services_and_types(
    services_glob: Sequence[str] | None, include_hidden: bool = False
) -> tuple[list[str], list[str]]:
    """Return the services, and their types in the same order."""
    return _allowed(_services(include_hidden), services_glob)


def get_services_for_type(
    service_type: str, services_glob: Sequence[str] | None, include_hidden: bool = False
) -> list[str]:
    """Return the services of a type."""
    return _of_type(_services(include_hidden), service_type, services_glob)


def get_nodes(include_hidden: bool = False) -> list[str]:
    """Return the full names of the nodes."""
    full = {f"{namespace.rstrip('/')}/{name}" for name, namespace in _asker().get_node_names_and_namespaces()}
    return sorted(name for name in full if include_hidden or not _is_hidden(name))


def get_node_info(node_name: str, include_hidden: bool = False) -> tuple[list[str], list[str], list[str]]:
    """Return what a node subscribes to, publishes and serves; nothing where there is no such node."""
    if node_name not in get_nodes(include_hidden):
        return [], [], []
    return get_node_subscriptions(node_name), get_node_publications(node_name), get_node_services(node_name)


def _of_node(find: Callable[[str, str], Names], node_name: str) -> Names:
    namespace, _, name = node_name.rpartition("/")
    return find(name, namespace or "/")


def get_node_publications(node_name: str) -> list[str]:
    """Return the topics that a node publishes."""
    return [name for name, _ in _of_node(_asker().get_publisher_names_and_types_by_node, node_name)]


def get_node_subscriptions(node_name: str) -> list[str]:
    """Return the topics that a node subscribes to."""
    return [name for name, _ in _of_node(_asker().get_subscriber_names_and_types_by_node, node_name)]


def get_node_services(node_name: str) -> list[str]:
    """Return the services of a node."""
    return [name for name, _ in _of_node(_asker().get_service_names_and_types_by_node, node_name)]


def get_node_service_types(node_name: str) -> list[str]:
    """Return the types of the services of a node."""
    return [types[0] for _, types in _of_node(_asker().get_service_names_and_types_by_node, node_name)]


def get_topic_type(topic: str, topics_glob: Sequence[str] | None) -> str:
    """Return the type of a topic, an empty text where there is no such topic."""
    return dict(zip(*get_topics_and_types(topics_glob), strict=True)).get(topic, "")


def get_service_type(service: str, services_glob: Sequence[str] | None) -> str:
    """Return the type of a service, an empty text where there is no such service."""
    return dict(zip(*get_services_and_types(services_glob), strict=True)).get(service, "")


def filter_action_servers(topics: Sequence[str]) -> list[str]:
    """Return the actions of which feedback and status are among some topics."""
    feedback, status = ({topic.removesuffix(end) for topic in topics if topic.endswith(end)} for end in _ACTION_TOPICS)
    return sorted(feedback & status)


def get_publishers(topic: str, topics_glob: Sequence[str] | None, include_hidden: bool = False) -> list[str]:
    """Return the nodes that publish a topic."""
    return _holders(topic, topics_glob, get_node_publications, include_hidden)


def get_subscribers(topic: str, topics_glob: Sequence[str] | None, include_hidden: bool = False) -> list[str]:
    """Return the nodes that subscribe to a topic."""
    return _holders(topic, topics_glob, get_node_subscriptions, include_hidden)


def get_service_providers(
    queried_type: str, services_glob: Sequence[str] | None, include_hidden: bool = False
) -> list[str]:
    """Return the nodes with a service of a type."""
    return _holders(queried_type, services_glob, get_node_service_types, include_hidden)


def get_service_node(queried_type: str, services_glob: Sequence[str] | None, include_hidden: bool = False) -> str:
    """Return the node of a service, an empty text where there is no such service."""
    return next(iter(_holders(queried_type, services_glob, get_node_services, include_hidden)), "")


def _holders(
    wanted: str, globs: Sequence[str] | None, find: Callable[[str], list[str]], include_hidden: bool
) -> list[str]:
    if not any_match(wanted, globs):
        return []
    return [node for node in get_nodes(include_hidden) if wanted in find(node)]
