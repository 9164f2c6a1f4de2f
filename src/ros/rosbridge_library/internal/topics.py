"""Types of topics, for publishers and subscriptions alike."""

from __future__ import annotations

from typing import Any

from rclpy.node import Node

from rosbridge_library.internal import ros_loader
from rosbridge_library.internal.message_conversion import msg_class_type_repr


class TopicNotEstablishedException(Exception):
    """Error of a topic that does not exist, so that its type must be given."""

    def __init__(self, topic: str) -> None:
        super().__init__(f"Cannot infer topic type for topic {topic} as it is not yet advertised")


class TypeConflictException(Exception):
    """Error of a topic that has another type."""

    def __init__(self, topic: str, orig_type: str, new_type: str) -> None:
        super().__init__(
            f"Tried to register topic {topic} with type {new_type} but it is already established with type {orig_type}"
        )


def topic_class(node: Node, topic: str, msg_type: str | None) -> Any:
    """Return the class of a topic's messages.

    Parameters
    ----------
    node
        Asks the graph.
    topic
        Name of the topic.
    msg_type
        The type that the client names; None takes that of the graph.

    Raises
    ------
    TopicNotEstablishedException, TypeConflictException
        Where neither the client nor the graph knows the type, and where they differ.
    """
    found = dict(node.get_topic_names_and_types()).get(topic, [])
    if len(found) > 1:
        node.get_logger().warning(f"More than one topic type detected: {found}")
    if msg_type is None and not found:
        raise TopicNotEstablishedException(topic)
    kind = ros_loader.get_message_class(found[0] if msg_type is None else msg_type)
    name = msg_class_type_repr(kind)
    if found and found[0] != name:
        raise TypeConflictException(topic, found[0], name)
    return kind


def check_class(kind: Any, topic: str, msg_type: str) -> None:
    """Raise a `TypeConflictException` where a type is not that of a topic's class."""
    if ros_loader.get_message_class(msg_type) is not kind:
        raise TypeConflictException(topic, msg_class_type_repr(kind), msg_type)
