"""Graph queries of a node."""

from __future__ import annotations

from daidalos.transport.graph import EndpointKind, names_and_types
from rclpy.exceptions import InvalidServiceNameException, InvalidTopicNameException
from rclpy.impl.entities import NodeHandle
from rclpy.topic_endpoint_info import TopicEndpointInfo
from rclpy.validate_full_topic_name import validate_full_topic_name
from rclpy.validate_topic_name import validate_topic_name

_TOPICS = (EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION)


class NodeGraph:
    """The part of `Node` that has to do with other nodes."""

    handle: NodeHandle

    def get_publisher_names_and_types_by_node(
        self, node_name: str, node_namespace: str, no_demangle: bool = False
    ) -> list[tuple[str, list[str]]]:
        """Return what a node publishes: [(topic, [types])]; NodeNameNonExistentError when it is not there."""
        return self._rcl_by_node(node_name, node_namespace, EndpointKind.PUBLISHER)

    def get_subscriber_names_and_types_by_node(
        self, node_name: str, node_namespace: str, no_demangle: bool = False
    ) -> list[tuple[str, list[str]]]:
        """Return what a node subscribes to: [(topic, [types])]; NodeNameNonExistentError when it is not there."""
        return self._rcl_by_node(node_name, node_namespace, EndpointKind.SUBSCRIPTION)

    def get_service_names_and_types_by_node(self, node_name: str, node_namespace: str) -> list[tuple[str, list[str]]]:
        """Return what a node serves: [(service, [types])]; NodeNameNonExistentError when it is not there."""
        return self._rcl_by_node(node_name, node_namespace, EndpointKind.SERVICE)

    def get_client_names_and_types_by_node(self, node_name: str, node_namespace: str) -> list[tuple[str, list[str]]]:
        """Return what a node calls: [(service, [types])]; NodeNameNonExistentError when it is not there."""
        return self._rcl_by_node(node_name, node_namespace, EndpointKind.CLIENT)

    def _rcl_by_node(self, name: str, namespace: str, kind: EndpointKind) -> list[tuple[str, list[str]]]:
        with self.handle as handle:
            return handle.names_and_types_of(name, namespace, kind)

    def get_topic_names_and_types(self, no_demangle: bool = False) -> list[tuple[str, list[str]]]:
        """Return every topic: [(name, [types])]."""
        with self.handle as handle:
            return names_and_types(handle.graph.endpoints(*_TOPICS))

    def get_service_names_and_types(self) -> list[tuple[str, list[str]]]:
        """Return every service: [(name, [types])]."""
        with self.handle as handle:
            return names_and_types(handle.graph.endpoints(EndpointKind.SERVICE, EndpointKind.CLIENT))

    def get_action_names_and_types(self) -> list[tuple[str, list[str]]]:
        """Return every action: [(name, [types])]."""
        from rclpy.action.graph import get_action_names_and_types

        return get_action_names_and_types(self)  # type: ignore[arg-type]

    def get_action_client_names_and_types_by_node(
        self, node_name: str, node_namespace: str
    ) -> list[tuple[str, list[str]]]:
        """Return the actions that a node calls: [(name, [types])]."""
        from rclpy.action.graph import get_action_client_names_and_types_by_node

        return get_action_client_names_and_types_by_node(self, node_name, node_namespace)  # type: ignore[arg-type]

    def get_action_server_names_and_types_by_node(
        self, node_name: str, node_namespace: str
    ) -> list[tuple[str, list[str]]]:
        """Return the actions that a node serves: [(name, [types])]."""
        from rclpy.action.graph import get_action_server_names_and_types_by_node

        return get_action_server_names_and_types_by_node(self, node_name, node_namespace)  # type: ignore[arg-type]

    def get_node_names(self) -> list[str]:
        """Return every node's name."""
        return [name for name, _ in self.get_node_names_and_namespaces()]

    def get_fully_qualified_node_names(self) -> list[str]:
        """Return every node's full name."""
        with self.handle as handle:
            return [node.full_name for node in handle.graph.nodes()]

    def get_node_names_and_namespaces(self) -> list[tuple[str, str]]:
        """Return every node's (name, namespace)."""
        with self.handle as handle:
            return [(node.name, node.namespace) for node in handle.graph.nodes()]

    def get_node_names_and_namespaces_with_enclaves(self) -> list[tuple[str, str, str]]:
        """Return every node's (name, namespace, enclave)."""
        with self.handle as handle:
            return [(node.name, node.namespace, node.enclave) for node in handle.graph.nodes()]

    def count_publishers(self, topic_name: str) -> int:
        """Return how many publishers a topic has."""
        return self._rcl_count(topic_name, EndpointKind.PUBLISHER)

    def count_subscribers(self, topic_name: str) -> int:
        """Return how many subscriptions a topic has."""
        return self._rcl_count(topic_name, EndpointKind.SUBSCRIPTION)

    def count_clients(self, service_name: str) -> int:
        """Return how many clients a service has."""
        return self._rcl_count(service_name, EndpointKind.CLIENT)

    def count_services(self, service_name: str) -> int:
        """Return how many servers a service has."""
        return self._rcl_count(service_name, EndpointKind.SERVICE)

    def _rcl_count(self, name: str, kind: EndpointKind) -> int:
        is_service = kind in (EndpointKind.SERVICE, EndpointKind.CLIENT)
        with self.handle as handle:
            full = _asked_name(handle, name, is_service=is_service)
            return len(handle.graph.endpoints(kind, name=full))

    def get_publishers_info_by_topic(self, topic_name: str, no_mangle: bool = False) -> list[TopicEndpointInfo]:
        """Return what is known of a topic's publishers."""
        return self._rcl_infos(topic_name, EndpointKind.PUBLISHER, no_mangle)

    def get_subscriptions_info_by_topic(self, topic_name: str, no_mangle: bool = False) -> list[TopicEndpointInfo]:
        """Return what is known of a topic's subscriptions."""
        return self._rcl_infos(topic_name, EndpointKind.SUBSCRIPTION, no_mangle)

    def _rcl_infos(self, topic_name: str, kind: EndpointKind, no_mangle: bool) -> list[TopicEndpointInfo]:
        with self.handle as handle:
            name = topic_name if no_mangle else _asked_name(handle, topic_name, is_service=False)
            return [TopicEndpointInfo.from_endpoint(one) for one in handle.graph.endpoints(kind, name=name)]

    def wait_for_node(self, fully_qualified_node_name: str, timeout: float) -> bool:
        """Wait until a node is there; False when `timeout` seconds pass first."""
        if not fully_qualified_node_name.startswith("/"):
            fully_qualified_node_name = f"/{fully_qualified_node_name}"
        with self.handle as handle:
            graph = handle.graph
            return graph.wait_for(
                lambda: any(node.full_name == fully_qualified_node_name for node in graph.nodes()), timeout
            )

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        """Return a topic's full name, remapped unless `only_expand`.

        Raises
        ------
        InvalidTopicNameException
            When it breaks the rules.
        """
        with self.handle as handle:
            return checked_name(handle, topic, is_service=False, only_expand=only_expand)

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        """Return a service's full name, remapped unless `only_expand`.

        Raises
        ------
        InvalidServiceNameException
            When it breaks the rules.
        """
        with self.handle as handle:
            return checked_name(handle, service, is_service=True, only_expand=only_expand)


def _asked_name(handle: NodeHandle, name: str, *, is_service: bool) -> str:
    """Return the full name of what somebody asks about.

    Raises
    ------
    TypeError
        When it is not a string.
    ValueError
        When it breaks the rules.
    """
    if not isinstance(name, str):
        raise TypeError(f"bad argument type for built-in operation: a name must be a string, not {type(name).__name__}")
    try:
        return checked_name(handle, name, is_service=is_service)
    except ValueError as error:
        raise ValueError(f"{'service' if is_service else 'topic'} name '{name}' is invalid: {error}") from None


def checked_name(handle: NodeHandle, name: str, *, is_service: bool, only_expand: bool = False) -> str:
    """Return the full name of a topic or service of a node.

    Raises
    ------
    InvalidTopicNameException, InvalidServiceNameException
        When it breaks the rules.
    """
    validate_topic_name(name, is_service=is_service)
    try:
        full = handle.resolve_name(name, is_service=is_service, only_expand=only_expand)
    except ValueError as error:
        kind = InvalidServiceNameException if is_service else InvalidTopicNameException
        raise kind(name, str(error), name.find("{")) from None
    validate_full_topic_name(full, is_service=is_service)
    return full
