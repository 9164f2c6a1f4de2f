"""Questions to a node about what it publishes and subscribes to."""

from __future__ import annotations

from rclpy.node import Node


def is_topic_published(node: Node, topic_name: str) -> bool:
    """Return whether a node publishes a topic."""
    found = node.get_publisher_names_and_types_by_node(node.get_name(), node.get_namespace())
    return any(name == topic_name for name, _ in found)


def is_topic_subscribed(node: Node, topic_name: str) -> bool:
    """Return whether a node subscribes to a topic."""
    found = node.get_subscriber_names_and_types_by_node(node.get_name(), node.get_namespace())
    return any(name == topic_name for name, _ in found)
