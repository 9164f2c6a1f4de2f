"""Publishers that clients share, one for each topic."""

from __future__ import annotations

import threading
import time
from collections.abc import Hashable
from typing import Any

from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile

from daidalos.transport.steady_timers import STEADY_TIMERS, SteadyTimer
from rosbridge_library.internal.message_conversion import populate_instance
from rosbridge_library.internal.topics import check_class, topic_class

_MAX_DEPTH = 1000
_LIFESPAN_S = 1.0
"""Time for which a message is kept for subscriptions that come late: clients publish right after they advertise."""


class MultiPublisher:
    """Publisher of a topic and the clients that use it.

    Parameters
    ----------
    topic
        Name of the topic.
    node_handle
        Node that publishes.
    msg_type
        Type of the messages; None takes that of the graph.
    latched_client_id
        The client that asked for the last message to be kept for who subscribes later; None where none did.
    queue_size
        Messages kept for a slow subscription.

    Raises
    ------
    TopicNotEstablishedException, TypeConflictException
        See `rosbridge_library.internal.topics.topic_class`.
    """

    def __init__(
        self,
        topic: str,
        node_handle: Node,
        msg_type: str | None = None,
        latched_client_id: Hashable | None = None,
        queue_size: int = 100,
    ) -> None:
        self.msg_class = topic_class(node_handle, topic, msg_type)
        self.clients: dict[Hashable, bool] = {}
        self.latched_client_id = latched_client_id
        self.topic = topic
        self.node_handle = node_handle
        depth = min(max(queue_size, 1), _MAX_DEPTH)
        qos = QoSProfile(depth=depth, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        if latched_client_id is None:
            qos.lifespan = Duration(seconds=_LIFESPAN_S)
        else:
            qos.depth = 1
        self.publisher = node_handle.create_publisher(self.msg_class, topic, qos)

    def unregister(self) -> None:
        """Publish no longer."""
        self.node_handle.destroy_publisher(self.publisher)
        self.clients.clear()

    def verify_type(self, msg_type: str) -> None:
        """Raise a TypeConflictException where a type is not that of the publisher."""
        check_class(self.msg_class, self.topic, msg_type)

    def publish(self, msg: dict[str, Any]) -> None:
        """Publish a message of fields and values; raises what `populate_instance` does."""
        self.publisher.publish(populate_instance(msg, self.msg_class(), self.node_handle.get_clock()))

    def register_client(self, client_id: Hashable) -> None:
        """Add a client."""
        self.clients[client_id] = True

    def unregister_client(self, client_id: Hashable) -> None:
        """Remove a client, where it is one."""
        self.clients.pop(client_id, None)

    def has_clients(self) -> bool:
        """Return whether a client uses the publisher."""
        return bool(self.clients)


class PublisherManager:
    """Publishers by topic; one without clients is destroyed after a while, as clients often come back.

    Attributes
    ----------
    unregister_timeout : float
        That while, in seconds.
    """

    def __init__(self) -> None:
        self._publishers: dict[str, MultiPublisher] = {}
        self._lock = threading.RLock()
        self.unregister_timers: dict[str, SteadyTimer] = {}
        self.unregister_timeout = 10.0

    def register(
        self,
        client_id: Hashable,
        topic: str,
        node_handle: Node,
        msg_type: str | None = None,
        latch: bool = False,
        queue_size: int = 100,
    ) -> None:
        """Make a client one of a topic's publisher; raises what `MultiPublisher` does."""
        with self._lock:
            publisher = self._publishers.get(topic)
            if publisher is None:
                publisher = MultiPublisher(topic, node_handle, msg_type, client_id if latch else None, queue_size)
                self._publishers[topic] = publisher
            elif latch != (publisher.latched_client_id is not None) and client_id not in publisher.clients:
                node_handle.get_logger().warning(
                    f"client {client_id} advertises {topic} {'with' if latch else 'without'} 'latch', but an earlier "
                    "client did not choose so, which counts for all"
                )
            if msg_type is not None:
                publisher.verify_type(msg_type)
            publisher.register_client(client_id)

    def unregister(self, client_id: Hashable, topic: str) -> None:
        """Remove a client of a topic's publisher, and the publisher after `unregister_timeout` without clients."""
        with self._lock:
            publisher = self._publishers.get(topic)
            if publisher is None:
                return
            publisher.unregister_client(client_id)
            earlier = self.unregister_timers.pop(topic, None)
            if earlier is not None:
                earlier.cancel()
            due_ns = time.monotonic_ns() + int(self.unregister_timeout * 1e9)
            self.unregister_timers[topic] = STEADY_TIMERS.at(due_ns, lambda: self._remove_unused(topic, publisher))

    def _remove_unused(self, topic: str, publisher: MultiPublisher) -> None:
        with self._lock:
            if self._publishers.get(topic) is not publisher:
                return
            if not publisher.has_clients():
                del self._publishers[topic]
                publisher.unregister()
            self.unregister_timers.pop(topic, None)

    def unregister_all(self, client_id: Hashable) -> None:
        """Remove a client of all publishers."""
        with self._lock:
            for topic in [topic for topic, one in self._publishers.items() if client_id in one.clients]:
                self.unregister(client_id, topic)

    def forget(self, node_handle: Node) -> None:
        """Destroy the publishers of a node that ends."""
        with self._lock:
            for topic in [topic for topic, one in self._publishers.items() if one.node_handle is node_handle]:
                timer = self.unregister_timers.pop(topic, None)
                if timer is not None:
                    timer.cancel()
                self._publishers.pop(topic).unregister()

    def publish(
        self,
        client_id: Hashable,
        topic: str,
        msg: dict[str, Any],
        node_handle: Node,
        latch: bool = False,
        queue_size: int = 100,
    ) -> None:
        """Publish a message of fields and values, of which a client must not have advertised the topic before."""
        with self._lock:
            self.register(client_id, topic, node_handle, latch=latch, queue_size=queue_size)
            publisher = self._publishers[topic]
        publisher.publish(msg)


manager = PublisherManager()
"""The publishers of this process."""
