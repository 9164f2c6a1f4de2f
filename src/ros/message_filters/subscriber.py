"""From a topic into a filter."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .simple_filter import SimpleFilter

if TYPE_CHECKING:
    from rclpy.node import Node
    from rclpy.qos import QoSProfile


class Subscriber(SimpleFilter):
    """Filter that passes the messages of a topic; other attributes are the subscription's.

    Parameters
    ----------
    node
        The node to subscribe with.
    msg_type
        Class of the messages.
    topic
        The topic's name.
    qos_profile
        Quality of service; a number means KEEP_LAST with that depth.
    options
        Further arguments of `Node.create_subscription`.
    """

    def __init__(
        self, node: Node, msg_type: Any, topic: str, qos_profile: QoSProfile | int = 10, **options: Any
    ) -> None:
        super().__init__()
        self.node = node
        self.topic = topic
        self.sub = node.create_subscription(msg_type, topic, self.callback, qos_profile, **options)

    def callback(self, msg: Any) -> None:
        """Pass a message to the callbacks."""
        self.signalMessage(msg)

    def getTopic(self) -> str:
        """Return the topic's name as it was given."""
        return self.topic

    def __getattr__(self, key: str) -> Any:
        if key == "sub":  # there is none yet
            raise AttributeError(key)
        return getattr(self.sub, key)
