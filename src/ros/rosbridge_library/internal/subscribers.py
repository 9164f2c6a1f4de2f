"""Subscriptions that clients share, one for each topic."""

from __future__ import annotations

import threading
from collections.abc import Callable, Hashable, Iterable
from typing import Any

from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.subscription import Subscription

from rosbridge_library.internal.outgoing_message import OutgoingMessage
from rosbridge_library.internal.topics import check_class, topic_class

_DEPTH = 10
Callback = Callable[[OutgoingMessage], Any]


class MultiSubscriber:
    """Subscription of a topic and the clients that get its messages.

    A client that comes later has a second subscription until its first message, so that it gets messages that
    publishers keep for late subscriptions, and earlier clients do not get them again.

    Parameters
    ----------
    topic
        Name of the topic.
    client_id, callback
        The first client, and what gets its messages.
    node_handle
        Node that subscribes.
    msg_type
        Type of the messages; None takes that of the graph.
    raw
        Whether the client wants the messages' bytes; they are decoded where another one wants more.

    Raises
    ------
    TopicNotEstablishedException, TypeConflictException
        See `rosbridge_library.internal.topics.topic_class`.
    """

    def __init__(
        self,
        topic: str,
        client_id: Hashable,
        callback: Callback,
        node_handle: Node,
        msg_type: str | None = None,
        raw: bool = False,
    ) -> None:
        self.msg_class = topic_class(node_handle, topic, msg_type)
        self.subscriptions: dict[Hashable, Callback] = {client_id: callback}
        self.new_subscriptions: dict[Hashable, Callback] = {}
        self.rlock = threading.RLock()
        self.node_handle = node_handle
        self.topic = topic
        self.raw = raw
        self.callback_group = MutuallyExclusiveCallbackGroup()
        self.qos = self._matching_qos()
        self.subscriber: Subscription | None = self._create(self.callback)
        self.new_subscriber: Subscription | None = None

    def _matching_qos(self) -> QoSProfile:
        """Return a profile that the publishers known so far satisfy."""
        offered = [one.qos_profile for one in self.node_handle.get_publishers_info_by_topic(self.topic)]
        best_effort = any(one.reliability == ReliabilityPolicy.BEST_EFFORT for one in offered)
        latched = bool(offered) and all(one.durability == DurabilityPolicy.TRANSIENT_LOCAL for one in offered)
        return QoSProfile(
            depth=_DEPTH,
            reliability=ReliabilityPolicy.BEST_EFFORT if best_effort else ReliabilityPolicy.RELIABLE,
            durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
        )

    def _create(self, receive: Callable[[Any], None]) -> Subscription:
        return self.node_handle.create_subscription(
            self.msg_class,
            self.topic,
            receive,
            self.qos,
            raw=True,
            callback_group=self.callback_group,
            event_callbacks=SubscriptionEventCallbacks(incompatible_qos=lambda _: self._match_again()),
        )

    def _match_again(self) -> None:
        """Subscribe with a profile that a publisher satisfies which came later than the subscription."""
        with self.rlock:
            qos = self._matching_qos()
            if self.subscriber is None or qos == self.qos:
                return
            self.qos = qos
            self.node_handle.destroy_subscription(self.subscriber)
            self.subscriber = self._create(self.callback)
            if self.new_subscriber is not None:
                self.node_handle.destroy_subscription(self.new_subscriber)
                self.new_subscriber = self._create(self._new_sub_callback)

    def unregister(self) -> None:
        """Subscribe no longer."""
        with self.rlock:
            self.subscriptions.clear()
            self.new_subscriptions.clear()
            for one in (self.subscriber, self.new_subscriber):
                if one is not None:
                    self.node_handle.destroy_subscription(one)
            self.subscriber = self.new_subscriber = None

    def verify_type(self, msg_type: str) -> None:
        """Raise a TypeConflictException where a type is not that of the subscription."""
        check_class(self.msg_class, self.topic, msg_type)

    def subscribe(self, client_id: Hashable, callback: Callback) -> None:
        """Add a client, or replace its callback."""
        with self.rlock:
            if client_id in self.subscriptions:
                self.subscriptions[client_id] = callback
            self.new_subscriptions[client_id] = callback
            self._match_again()
            if self.new_subscriber is None:
                self.new_subscriber = self._create(self._new_sub_callback)

    def unsubscribe(self, client_id: Hashable) -> None:
        """Remove a client, where it is one."""
        with self.rlock:
            self.subscriptions.pop(client_id, None)
            self.new_subscriptions.pop(client_id, None)

    def has_subscribers(self) -> bool:
        """Return whether a client gets the messages."""
        with self.rlock:
            return bool(self.subscriptions or self.new_subscriptions)

    def callback(self, msg: bytes, callbacks: Iterable[Callback] | None = None) -> None:
        """Pass a message, as bytes, to clients: all of them unless told otherwise."""
        outgoing = OutgoingMessage(msg, self.msg_class)
        with self.rlock:
            for one in list(self.subscriptions.values() if callbacks is None else callbacks):
                try:
                    one(outgoing)
                except Exception as error:  # of one client, which the others have no part in
                    self.node_handle.get_logger().error(f"Exception calling subscribe callback: {error}")

    def _new_sub_callback(self, msg: bytes) -> None:
        with self.rlock:
            if self.new_subscriber is None:
                return
            # A client that is there already gets the message from the other subscription.
            newcomers = self.new_subscriptions.keys() - self.subscriptions.keys()
            self.callback(msg, [self.new_subscriptions[one] for one in newcomers])
            self.subscriptions.update(self.new_subscriptions)
            self.new_subscriptions = {}
            self.node_handle.destroy_subscription(self.new_subscriber)
            self.new_subscriber = None


class SubscriberManager:
    """Subscriptions by topic."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._subscribers: dict[str, MultiSubscriber] = {}

    def subscribe(
        self,
        client_id: Hashable,
        topic: str,
        callback: Callback,
        node_handle: Node,
        msg_type: str | None = None,
        raw: bool = False,
    ) -> None:
        """Pass a topic's messages to a client; raises what `MultiSubscriber` does."""
        with self._lock:
            subscriber = self._subscribers.get(topic)
            if subscriber is None:
                self._subscribers[topic] = MultiSubscriber(topic, client_id, callback, node_handle, msg_type, raw)
                return
            if msg_type is not None:
                subscriber.verify_type(msg_type)
            subscriber.subscribe(client_id, callback)

    def unsubscribe(self, client_id: Hashable, topic: str) -> None:
        """Pass a topic's messages to a client no longer."""
        with self._lock:
            subscriber = self._subscribers.get(topic)
            if subscriber is None:
                return
            subscriber.unsubscribe(client_id)
            if not subscriber.has_subscribers():
                del self._subscribers[topic]
                subscriber.unregister()


manager = SubscriberManager()
"""The subscriptions of this process."""
