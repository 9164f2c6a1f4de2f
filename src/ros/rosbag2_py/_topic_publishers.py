"""Publishers of a player's messages, and clients that repeat recorded requests."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any

from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile
from rclpy.serialization import deserialize_message

from daidalos.bags.message import BagMessage, Topic
from daidalos.interfaces.codec import CdrError
from daidalos.transport.qos import INFINITE_NS, Durability, History, Liveliness, Qos, Reliability
from rosbag2_py._options import PlayOptions, ServiceRequestsSource
from rosbag2_py._qos import common
from rosbag2_py._types import message_class, opaque_class, service_class

_DEPTH = 10
_REQUEST_EVENTS = {ServiceRequestsSource.SERVICE_INTROSPECTION: 1, ServiceRequestsSource.CLIENT_INTROSPECTION: 0}
"""Kind of the event that a service, or a client, publishes of a request."""


class TopicPublishers:
    """Publishers of the messages of some topics.

    Parameters
    ----------
    node
        Who publishes.
    topics
        The topics.
    options
        How.
    """

    def __init__(self, node: Node, topics: Iterable[Topic], options: PlayOptions) -> None:
        self._node = node
        self._options = options
        self._ways: dict[str, Callable[[bytes], None]] = {}
        self._publishers: list[Publisher] = []
        for topic in topics:
            way = self._way(topic)
            if way is not None:
                self._ways[topic.name] = way

    @property
    def names(self) -> list[str]:
        """The topics that can be published."""
        return list(self._ways)

    def publish(self, message: BagMessage) -> None:
        """Publish a message."""
        self._ways[message.topic](message.data)

    def wait_for_all_acked(self, timeout_ms: int) -> None:
        """Wait until subscriptions have all messages: so many milliseconds, 0 for no limit, negative for not at all."""
        if timeout_ms < 0:
            return
        timeout = Duration(nanoseconds=timeout_ms * 1_000_000 or -1)
        for publisher in self._publishers:
            if not publisher.wait_for_all_acked(timeout):
                self._node.get_logger().error(
                    f"Timed out while waiting for all published messages to be acknowledged for topic "
                    f"{publisher.topic_name}"
                )

    def _way(self, topic: Topic) -> Callable[[bytes], None] | None:
        """Return what is done with a topic's messages, None where nothing can be."""
        logger = self._node.get_logger()
        if topic.serialization_format not in ("cdr", ""):
            logger.warning(
                f"Ignoring a topic '{topic.name}', reason: its serialization format is "
                f"'{topic.serialization_format}', known is 'cdr'."
            )
            return None
        kind = message_class(topic.type)
        if topic.is_service_event and self._options.publish_service_requests:
            return self._request_sender(topic, kind)
        if kind is None and not topic.type_hash:
            package = topic.type.partition("/")[0]
            logger.warning(
                f"Ignoring a topic '{topic.name}', reason: the type '{topic.type}' is not known: "
                f"no package '{package}' with it is installed, and the bag has no hash of it."
            )
            return None
        if kind is None or (topic.type_hash and topic.type_hash != kind._TYPE_HASH):
            what = "is not installed" if kind is None else "is defined otherwise here"
            logger.warning(
                f"Topic '{topic.name}': its type '{topic.type}' {what}; its messages are passed on as they were "
                "recorded, to who has the same definition."
            )
            kind = opaque_class(topic.type, topic.type_hash)
        publisher = self._node.create_publisher(kind, topic.name, self._qos(topic))
        self._publishers.append(publisher)
        send: Callable[[bytes], None] = publisher.publish
        return send

    def _qos(self, topic: Topic) -> QoSProfile:
        """Return what is offered: what the recorded publishers offered where they agreed."""
        override = self._options.topic_qos_profile_overrides.get(topic.name)
        if override is not None:
            self._node.get_logger().info(f"Overriding QoS profile for topic {topic.name}")
            return override
        if not topic.qos:
            return QoSProfile(depth=_DEPTH)
        offered = common([_certain(one) for one in topic.qos])
        if offered is None:
            self._node.get_logger().warning(
                f"Not all original publishers on topic {topic.name} offered the same QoS profiles. "
                "Rosbag2 cannot yet choose an adapted profile to offer for this mix. "
                "Falling back to the rosbag2_transport default publisher offer."
            )
            return QoSProfile(depth=_DEPTH)
        return QoSProfile.from_resolved(offered)

    def _request_sender(self, topic: Topic, event_class: Any) -> Callable[[bytes], None] | None:
        """Return a client that sends the requests of a service's events again."""
        logger = self._node.get_logger()
        kind = service_class(topic.service_type)
        if kind is None or event_class is None:
            logger.warning(
                f"Ignoring a service '{topic.service_name}', reason: the type '{topic.service_type}' is not known."
            )
            return None
        client = self._node.create_client(kind, topic.service_name)
        wanted = _REQUEST_EVENTS[self._options.service_requests_source]

        def send(data: bytes) -> None:
            try:
                event = deserialize_message(data, event_class)
            except CdrError as error:
                logger.error(f"Failed to send a request on '{topic.service_name}' service: {error}")
                return
            if event.info.event_type != wanted:
                return
            if not event.request:
                logger.warning(
                    f"Failed to send a request on '{topic.service_name}' service: the event has no contents. "
                    "Was introspection set to contents while recording?",
                    once=True,
                )
            elif not client.service_is_ready():
                logger.error(
                    f"Service request hasn't been sent. The '{topic.service_name}' service isn't ready !", once=True
                )
            else:
                client.call_async(event.request[0])

        return send


def _certain(qos: Qos) -> Qos:
    """Return a profile without the values that a recorder did not know."""
    unknown_history = qos.history not in (History.KEEP_ALL, History.KEEP_LAST)
    manual = qos.liveliness is Liveliness.MANUAL_BY_TOPIC
    return replace(
        qos,
        history=History.KEEP_LAST if unknown_history else qos.history,
        depth=max(qos.depth, _DEPTH),
        reliability=Reliability.BEST_EFFORT if qos.reliability is Reliability.BEST_EFFORT else Reliability.RELIABLE,
        durability=Durability.TRANSIENT_LOCAL if qos.durability is Durability.TRANSIENT_LOCAL else Durability.VOLATILE,
        liveliness=Liveliness.MANUAL_BY_TOPIC if manual else Liveliness.AUTOMATIC,
        liveliness_lease_ns=qos.liveliness_lease_ns if manual else INFINITE_NS,
    )
