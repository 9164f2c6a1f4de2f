"""Topics whose messages the client gets."""

from __future__ import annotations

import json
from collections.abc import Callable, Hashable, Sequence
from functools import partial
from threading import Lock
from typing import TYPE_CHECKING, Any, ClassVar

from rclpy.node import Node

from rosbridge_library.capability import Capability, Field
from rosbridge_library.internal.exceptions import InvalidArgumentException
from rosbridge_library.internal.outgoing_message import OutgoingMessage
from rosbridge_library.internal.pngcompression import encode as encode_png
from rosbridge_library.internal.subscribers import manager
from rosbridge_library.internal.subscription_modifiers import MessageHandler

if TYPE_CHECKING:
    from rosbridge_library.protocol import Protocol

COMPRESSIONS = ("none", "png", "cbor", "cbor-raw")
"""Forms of published messages; of several that a client asks for of one topic, the last one here counts."""
_MAX_QUEUE = 1000


class Subscription:
    """Topic that a client subscribes to, maybe more than once under several ids, with a pace that suits all of them.

    Parameters
    ----------
    client_id
        The client.
    topic
        Name of the topic.
    publish
        Gets each message, the size of pieces and the form.
    node_handle
        Node that subscribes.
    """

    def __init__(
        self,
        client_id: Hashable,
        topic: str,
        publish: Callable[[OutgoingMessage, int | None, str], Any],
        node_handle: Node,
    ) -> None:
        self.client_id = client_id
        self.topic = topic
        self.publish = publish
        self.node_handle = node_handle
        self.clients: dict[Any, dict[str, Any]] = {}
        self.handler = MessageHandler(None, self._publish)
        self.handler_lock = Lock()
        self.update_params()

    def unregister(self) -> None:
        """Get no more messages."""
        manager.unsubscribe(self.client_id, self.topic)
        with self.handler_lock:
            self.handler.finish(block=False)
        self.clients.clear()

    def subscribe(
        self,
        sid: Any = None,
        msg_type: str | None = None,
        throttle_rate: int = 0,
        queue_length: int = 0,
        fragment_size: int | None = None,
        compression: str = "none",
    ) -> None:
        """Add a request for the messages.

        Parameters
        ----------
        sid
            Its id.
        msg_type
            Type of the messages; None takes that of the graph.
        throttle_rate
            Least time between two messages, in milliseconds.
        queue_length
            How many messages may wait for that.
        fragment_size
            Characters of a piece of a long message; None for that of the client.
        compression
            One of `COMPRESSIONS`.
        """
        manager.subscribe(
            self.client_id, self.topic, self.on_msg, self.node_handle, msg_type, raw=compression == "cbor-raw"
        )
        self.clients[sid] = {
            "throttle_rate": throttle_rate,
            "queue_length": queue_length,
            "fragment_size": fragment_size,
            "compression": compression,
        }
        self.update_params()

    def unsubscribe(self, sid: Any = None) -> None:
        """Remove the request of an id, or all of them."""
        if sid is None:
            self.clients.clear()
        else:
            self.clients.pop(sid, None)
        if self.clients:
            self.update_params()

    def is_empty(self) -> bool:
        """Return whether there is no request."""
        return not self.clients

    def _publish(self, message: OutgoingMessage) -> None:
        self.publish(message, self.fragment_size, self.compression)

    def on_msg(self, msg: OutgoingMessage) -> None:
        """Pass on a message at the pace of the requests."""
        with self.handler_lock:
            self.handler.handle_message(msg)

    def update_params(self) -> None:
        """Compute the pace and form that suit all requests: the least of each."""
        asked = list(self.clients.values())
        sizes = [one["fragment_size"] for one in asked if one["fragment_size"] is not None]
        self.throttle_rate = min((one["throttle_rate"] for one in asked), default=0)
        self.queue_length = min((one["queue_length"] for one in asked), default=0)
        self.fragment_size: int | None = min(sizes, default=None)
        self.compression = max((one["compression"] for one in asked), key=COMPRESSIONS.index, default="none")
        with self.handler_lock:
            self.handler = self.handler.set_throttle_rate(self.throttle_rate)
            self.handler = self.handler.set_queue_length(self.queue_length)


class Subscribe(Capability):
    """Operations ``subscribe`` and ``unsubscribe``."""

    subscribe_msg_fields: tuple[Field, ...] = (
        (True, "topic", str),
        (False, "type", (str, type(None))),
        (False, "throttle_rate", (int, float, type(None))),
        (False, "fragment_size", (int, type(None))),
        (False, "queue_length", (int, type(None))),
        (False, "compression", (str, type(None))),
        (False, "id", (str, int, type(None))),
    )
    unsubscribe_msg_fields: tuple[Field, ...] = ((True, "topic", str), (False, "id", (str, int, type(None))))
    topics_glob: ClassVar[Sequence[str] | None] = None

    def __init__(self, protocol: Protocol) -> None:
        super().__init__(protocol)
        self._subscriptions: dict[str, Subscription] = {}
        protocol.register_operation("subscribe", self.subscribe)
        protocol.register_operation("unsubscribe", self.unsubscribe)

    def subscribe(self, msg: dict[str, Any]) -> None:
        """Get messages of a topic."""
        self.basic_type_check(msg, self.subscribe_msg_fields)
        topic = msg["topic"]
        self.check_name(self.topics_glob, topic)
        compression = msg.get("compression") or "none"
        if compression not in COMPRESSIONS:
            known = ", ".join(COMPRESSIONS)
            raise InvalidArgumentException(f"Expected field compression to be one of {known}, got {compression!r:.100}")
        subscription = self._subscriptions.get(topic)
        if subscription is None:
            self.check_room(len(self._subscriptions), "topics are subscribed to")
            subscription = Subscription(
                self.protocol.client_id, topic, partial(self.publish, topic), self.protocol.node_handle
            )
        self.check_room(len(subscription.clients), "subscriptions of one topic")
        size = msg.get("fragment_size")
        subscription.subscribe(
            msg.get("id"),
            msg.get("type") or None,
            int(msg.get("throttle_rate") or 0),
            min(max(msg.get("queue_length") or 0, 0), _MAX_QUEUE),
            size if size is None or size > 0 else None,
            compression,
        )
        self._subscriptions[topic] = subscription

    def unsubscribe(self, msg: dict[str, Any]) -> None:
        """Get messages of a topic no longer."""
        self.basic_type_check(msg, self.unsubscribe_msg_fields)
        subscription = self._subscriptions.get(msg["topic"])
        if subscription is None:
            self.protocol.log("warning", f"{msg['topic']} is not subscribed to", msg.get("id"))
            return
        subscription.unsubscribe(msg.get("id"))
        if subscription.is_empty():
            subscription.unregister()
            del self._subscriptions[msg["topic"]]
            self.protocol.close_publication(msg["topic"])

    def publish(
        self, topic: str, message: OutgoingMessage, fragment_size: int | None = None, compression: str = "none"
    ) -> None:
        """Send a message to the client in a form of `COMPRESSIONS`."""
        outgoing: Any = {"op": "publish", "topic": topic}
        if compression == "cbor":
            outgoing = message.get_cbor(outgoing)
        elif compression == "cbor-raw":
            secs, nsecs = self.protocol.node_handle.get_clock().now().seconds_nanoseconds()
            outgoing["msg"] = {"secs": secs, "nsecs": nsecs, "bytes": message.message}
            outgoing = message.get_cbor_raw(outgoing)
        else:
            outgoing["msg"] = message.get_json_values()
            if compression == "png":
                outgoing = {"op": "png", "data": encode_png(json.dumps(outgoing)).decode()}
        self.protocol.send(outgoing, compression=compression, topic=topic)

    def finish(self) -> None:
        """Get no more messages."""
        for subscription in self._subscriptions.values():
            subscription.unregister()
        self._subscriptions.clear()
        self.protocol.unregister_operation("subscribe")
        self.protocol.unregister_operation("unsubscribe")
