"""Forwarding of topics of any type, found when they are published, as bytes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from rclpy.node import Node
from rclpy.qos import QoSProfile

from daidalos.nodes.message_classes import find_message_class
from daidalos.nodes.qos import matching_qos

_DEPTH = 10

Receiver = Callable[[bytes], None]


class TopicForwarder:
    """Subscriber and publisher of serialized messages, created as soon as the type is known.

    Parameters
    ----------
    node
        Subscribes and publishes.
    received
        Called with every message, as bytes.
    outputs
        Topics to publish on.
    lazy
        Whether to listen only while somebody listens to an output.
    """

    def __init__(self, node: Node, received: Receiver, outputs: Sequence[str], *, lazy: bool = False) -> None:
        self._node = node
        self._received = received
        self._lazy = lazy
        self._input = ""
        self._type = ""
        self._qos = QoSProfile(depth=_DEPTH)
        self._subscription: Any = None
        self._publishers: dict[str, Any] = {}
        self._outputs = [node.resolve_topic_name(name) for name in outputs]
        # The graph reports changes on its own thread; they are processed in the executor.
        self._look = node.create_guard_condition(self._update)
        self._stop = node.handle.graph.listen(lambda added, what: self._look.trigger())

    def take_from(self, topic: str) -> None:
        """Subscribe to this topic from now on, to none if it is empty."""
        self._input = self._node.resolve_topic_name(topic) if topic else ""
        self._unsubscribe()
        self._look.trigger()

    def add_output(self, topic: str) -> None:
        """Publish on this topic, too."""
        self._outputs.append(self._node.resolve_topic_name(topic))
        self._look.trigger()

    def remove_output(self, topic: str) -> None:
        """Publish on this topic no more."""
        name = self._node.resolve_topic_name(topic)
        self._outputs.remove(name)
        publisher = self._publishers.pop(name, None)
        if publisher is not None:
            self._node.destroy_publisher(publisher)

    def publish(self, content: bytes, topic: str | None = None) -> None:
        """Publish a message on one of the outputs, the first unless it is named."""
        name = self._outputs[0] if topic is None else self._node.resolve_topic_name(topic)
        publisher = self._publishers.get(name)
        if publisher is not None:
            publisher.publish(content)

    def close(self) -> None:
        """Stop listening to the graph."""
        self._stop()

    def _update(self) -> None:
        """Do what the graph allows now."""
        infos = self._node.get_publishers_info_by_topic(self._input) if self._input else []
        if infos:
            self._know(infos)
        if self._type:
            self._advertise()
        wanted = bool(infos) and (not self._lazy or self._has_subscribers())
        if wanted and self._subscription is None:
            kind = find_message_class(self._node, self._type)
            if kind is not None:
                self._subscription = self._node.create_subscription(
                    kind, self._input, self._received, self._qos, raw=True
                )
        elif not wanted and self._lazy:
            self._unsubscribe()

    def _know(self, infos: Sequence[Any]) -> None:
        """Record the type, and a quality of service compatible with all publishers."""
        self._type = infos[0].topic_type
        self._qos = matching_qos(infos, _DEPTH)

    def _advertise(self) -> None:
        for name in self._outputs:
            if name not in self._publishers:
                kind = find_message_class(self._node, self._type)
                if kind is not None:
                    self._publishers[name] = self._node.create_publisher(kind, name, self._qos)

    def _has_subscribers(self) -> bool:
        return any(publisher.get_subscription_count() for publisher in self._publishers.values())

    def _unsubscribe(self) -> None:
        subscription, self._subscription = self._subscription, None
        if subscription is not None:
            self._node.destroy_subscription(subscription)
