"""A listener between two topics that changes what passes."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rclpy.node import Node


class DataRepublisher:
    """Node that publishes what comes on one topic, changed, on another.

    Parameters
    ----------
    node
        Listens and publishes; somebody must spin it.
    listen_topic, publish_topic
        The names of the two topics.
    msg_type
        Of both topics.
    transform_fn
        Takes a message and returns the one to publish, or None where there is none to publish.
    """

    def __init__(
        self,
        node: Node,
        listen_topic: str,
        publish_topic: str,
        msg_type: type[Any],
        transform_fn: Callable[[Any], Any],
    ) -> None:
        self._node = node
        self._transform = transform_fn
        self._received = 0
        self._republished: list[Any] = []
        self._publisher = node.create_publisher(msg_type, publish_topic, 10)
        self._subscription = node.create_subscription(msg_type, listen_topic, self._forward_message, 10)

    def _forward_message(self, message: Any) -> None:
        self._received += 1
        changed = self._transform(message)
        if changed:
            self._republished.append(changed)
            self._publisher.publish(changed)

    def get_num_received(self) -> int:
        """Return how many messages have come."""
        return self._received

    def get_num_republished(self) -> int:
        """Return how many messages have been published, which leaves out those for which there was none."""
        return len(self._republished)

    def get_republished(self) -> list[Any]:
        """Return the published messages, the oldest first."""
        return list(self._republished)

    def shutdown(self) -> None:
        """Listen and publish no more."""
        self._node.destroy_subscription(self._subscription)
        self._node.destroy_publisher(self._publisher)
