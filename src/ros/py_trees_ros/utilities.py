"""Names, qualities of service, and tables of publishers, subscriptions and services."""

from __future__ import annotations

import os
import pathlib
import random
from collections.abc import Callable, Sequence
from typing import Any

from py_trees_ros_interfaces.msg import PublisherDetails, ServiceDetails, SubscriberDetails
from py_trees_ros_interfaces.srv import IntrospectPublishers, IntrospectServices, IntrospectSubscribers
from rclpy.expand_topic_name import expand_topic_name
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

from py_trees_ros.exceptions import MultipleFoundError, NotFoundError


def find_service(node: Node, service_type: str, namespace: str | None = None, timeout: float = 0.5) -> str:
    """Return the name of the only service of a type.

    Parameters
    ----------
    node
        Who asks.
    service_type
        Such as ``std_srvs/srv/SetBool``.
    namespace
        Text in the name, to choose among several.
    timeout
        How long to wait for one [s].

    Raises
    ------
    NotFoundError, MultipleFoundError
        When there is none, or more than one.
    """
    found = _waited(node, node.get_service_names_and_types, service_type, namespace, timeout)
    if not found:
        raise NotFoundError(f"service not found [type: {service_type}]")
    if len(found) > 1:
        raise MultipleFoundError(f"multiple services found [type: {service_type}]: {found}")
    return found[0]


def find_topics(node: Node, topic_type: str, namespace: str | None = None, timeout: float = 0.5) -> list[str]:
    """Return the names of the topics of a type; see `find_service`."""
    found = _waited(node, node.get_topic_names_and_types, topic_type, namespace, timeout)
    if not found:
        raise NotFoundError(f"topic not found [type: {topic_type}]")
    return found


def _waited(node: Node, listing: Callable[[], Any], kind: str, namespace: str | None, timeout: float) -> list[str]:
    def names() -> list[str]:
        return [name for name, types in listing() if kind in types and (namespace or "") in name]

    node.handle.graph.wait_for(lambda: bool(names()), timeout)
    return names()


def basename(name: str) -> str:
    """Return the last part of a name."""
    return name.rsplit("/", 1)[-1]


def get_py_trees_home() -> str:
    """Return the folder for files of py_trees, which is made if it does not exist."""
    home = os.path.join(pathlib.Path.home(), ".ros2", "py_trees")
    os.makedirs(home, exist_ok=True)
    return home


def qos_profile_latched() -> QoSProfile:
    """Return the profile of topics whose last message late subscriptions get."""
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=1,
        durability=DurabilityPolicy.TRANSIENT_LOCAL,
        reliability=ReliabilityPolicy.RELIABLE,
    )


def qos_profile_unlatched() -> QoSProfile:
    """Return the profile of topics whose messages only present subscriptions get."""
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=1,
        durability=DurabilityPolicy.VOLATILE,
        reliability=ReliabilityPolicy.RELIABLE,
    )


def resolve_name(node: Node, name: str) -> str:
    """Return the full name of a name of a node."""
    return expand_topic_name(name, node.get_name(), node.get_namespace())


def create_anonymous_node_name(node_name: str = "node") -> str:
    """Return a name of a node that others do not have."""
    return f"{node_name}_{os.getpid()}_{random.randrange(2**31)}"


class _Table:
    """Endpoints as attributes, and a service that lists them."""

    def __init__(self, node: Node, service_type: Any, topic: str, field: str) -> None:
        self._details: list[Any] = []
        self._field = field
        self.introspection_service = node.create_service(service_type, f"~/introspection/{topic}", self._answer)

    def _answer(self, request: Any, response: Any) -> Any:
        setattr(response, self._field, self._details)
        return response

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(f"there is no endpoint '{name}'")


class Publishers(_Table):
    """Publishers as attributes.

    Parameters
    ----------
    node
        Their node.
    publisher_details
        (attribute, topic, class of the messages, whether late subscriptions get the last message) of each.
    introspection_topic_name
        Name of the service that lists them, under ``~/introspection``.
    """

    def __init__(
        self,
        node: Node,
        publisher_details: Sequence[tuple[str, str, Any, bool]],
        introspection_topic_name: str = "publishers",
    ) -> None:
        super().__init__(node, IntrospectPublishers, introspection_topic_name, "publisher_details")
        for name, topic, kind, latched in publisher_details:
            profile = qos_profile_latched() if latched else qos_profile_unlatched()
            setattr(self, name, node.create_publisher(kind, topic, profile))
            self._details.append(
                PublisherDetails(topic_name=resolve_name(node, topic), message_type=_type(kind), latched=latched)
            )


class Subscribers(_Table):
    """Subscriptions as attributes.

    Parameters
    ----------
    node
        Their node.
    subscriber_details
        (attribute, topic, class of the messages, whether to get the last message of before, callback) of each.
    introspection_topic_name
        Name of the service that lists them, under ``~/introspection``.
    """

    def __init__(
        self,
        node: Node,
        subscriber_details: Sequence[tuple[str, str, Any, bool, Callable[[Any], Any]]],
        introspection_topic_name: str = "subscribers",
    ) -> None:
        super().__init__(node, IntrospectSubscribers, introspection_topic_name, "subscriber_details")
        for name, topic, kind, latched, callback in subscriber_details:
            profile = qos_profile_latched() if latched else qos_profile_unlatched()
            setattr(self, name, node.create_subscription(kind, topic, callback, profile))
            self._details.append(
                SubscriberDetails(topic_name=resolve_name(node, topic), message_type=_type(kind), latched=latched)
            )


class Services(_Table):
    """Services as attributes.

    Parameters
    ----------
    node
        Their node.
    service_details
        (attribute, name, class, callback) of each.
    introspection_topic_name
        Name of the service that lists them, under ``~/introspection``.
    """

    def __init__(
        self,
        node: Node,
        service_details: Sequence[tuple[str, str, Any, Callable[[Any, Any], Any]]],
        introspection_topic_name: str = "services",
    ) -> None:
        super().__init__(node, IntrospectServices, introspection_topic_name, "service_details")
        for name, service, kind, callback in service_details:
            setattr(self, name, node.create_service(kind, service, callback))
            self._details.append(ServiceDetails(service_name=resolve_name(node, service), service_type=_type(kind)))


def _type(kind: Any) -> str:
    return f"{kind.__module__.split('.')[0]}/{kind.__name__}"
