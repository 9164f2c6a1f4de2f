"""Messages that the client publishes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, ClassVar

from rosbridge_library.capabilities.advertise import set_timeout
from rosbridge_library.capability import Capability, Field
from rosbridge_library.internal.publishers import manager

if TYPE_CHECKING:
    from rosbridge_library.protocol import Protocol


class Publish(Capability):
    """Operation ``publish``; the topic need not be advertised where the graph knows its type."""

    publish_msg_fields: tuple[Field, ...] = (
        (True, "topic", str),
        (False, "msg", dict),
        (False, "latch", (bool, type(None))),
        (False, "queue_size", (int, type(None))),
    )
    topics_glob: ClassVar[Sequence[str] | None] = None

    def __init__(self, protocol: Protocol) -> None:
        super().__init__(protocol)
        self._published: set[str] = set()
        set_timeout(protocol)
        protocol.register_operation("publish", self.publish)

    def publish(self, message: dict[str, Any]) -> None:
        """Publish a message."""
        self.basic_type_check(message, self.publish_msg_fields)
        topic = message["topic"]
        self.check_name(self.topics_glob, topic)
        if topic not in self._published:
            self.check_room(len(self._published), "topics are published")
        latch, depth = bool(message.get("latch")), message.get("queue_size") or 100
        manager.publish(self.protocol.client_id, topic, message.get("msg", {}), self.protocol.node_handle, latch, depth)
        self._published.add(topic)

    def finish(self) -> None:
        """Publish nothing more."""
        for topic in self._published:
            manager.unregister(self.protocol.client_id, topic)
        self._published.clear()
        self.protocol.unregister_operation("publish")
