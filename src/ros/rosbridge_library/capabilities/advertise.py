"""Topics that the client publishes."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from typing import TYPE_CHECKING, Any, ClassVar

from rclpy.node import Node

from rosbridge_library.capability import Capability, Field
from rosbridge_library.internal.publishers import manager

if TYPE_CHECKING:
    from rosbridge_library.protocol import Protocol


class Registration:
    """Topic that a client advertises, maybe more than once under several ids."""

    def __init__(self, client_id: Hashable, topic: str, node_handle: Node) -> None:
        self.client_id = client_id
        self.topic = topic
        self.clients: dict[Any, bool] = {}
        self.node_handle = node_handle

    def unregister(self) -> None:
        """Publish the topic no longer."""
        manager.unregister(self.client_id, self.topic)

    def register_advertisement(
        self, msg_type: str, adv_id: Any = None, latch: bool = False, queue_size: int = 100
    ) -> None:
        """Add an advertisement; raises what `PublisherManager.register` does."""
        manager.register(
            self.client_id, self.topic, self.node_handle, msg_type=msg_type, latch=latch, queue_size=queue_size
        )
        self.clients[adv_id] = True

    def unregister_advertisement(self, adv_id: Any = None) -> None:
        """Remove the advertisement of an id, or all of them."""
        if adv_id is None:
            self.clients.clear()
        else:
            self.clients.pop(adv_id, None)

    def is_empty(self) -> bool:
        """Return whether there is no advertisement."""
        return not self.clients


class Advertise(Capability):
    """Operations ``advertise`` and ``unadvertise``."""

    advertise_msg_fields: tuple[Field, ...] = (
        (True, "topic", str),
        (True, "type", str),
        (False, "latch", (bool, type(None))),
        (False, "queue_size", (int, type(None))),
        (False, "id", (str, int, type(None))),
    )
    unadvertise_msg_fields: tuple[Field, ...] = ((True, "topic", str), (False, "id", (str, int, type(None))))
    topics_glob: ClassVar[Sequence[str] | None] = None

    def __init__(self, protocol: Protocol) -> None:
        super().__init__(protocol)
        self._registrations: dict[str, Registration] = {}
        set_timeout(protocol)
        protocol.register_operation("advertise", self.advertise)
        protocol.register_operation("unadvertise", self.unadvertise)

    def advertise(self, message: dict[str, Any]) -> None:
        """Publish a topic from now on."""
        self.basic_type_check(message, self.advertise_msg_fields)
        topic = message["topic"]
        self.check_name(self.topics_glob, topic)
        registration = self._registrations.get(topic)
        if registration is None:
            self.check_room(len(self._registrations), "topics are advertised")
            registration = Registration(self.protocol.client_id, topic, self.protocol.node_handle)
        latch, depth = bool(message.get("latch")), message.get("queue_size") or 100
        self.check_room(len(registration.clients), "advertisements of one topic")
        registration.register_advertisement(message["type"], message.get("id"), latch, depth)
        self._registrations[topic] = registration

    def unadvertise(self, message: dict[str, Any]) -> None:
        """Publish a topic no longer."""
        self.basic_type_check(message, self.unadvertise_msg_fields)
        topic = message["topic"]
        self.check_name(self.topics_glob, topic)
        registration = self._registrations.get(topic)
        if registration is None:
            self.protocol.log("warning", f"{topic} is not advertised", message.get("id"))
            return
        registration.unregister_advertisement(message.get("id"))
        if registration.is_empty():
            registration.unregister()
            del self._registrations[topic]

    def finish(self) -> None:
        """Publish nothing more."""
        for registration in self._registrations.values():
            registration.unregister()
        self._registrations.clear()
        self.protocol.unregister_operation("advertise")
        self.protocol.unregister_operation("unadvertise")


def set_timeout(protocol: Protocol) -> None:
    """Set the time for which publishers without clients stay, where a client's parameters have it."""
    timeout = (protocol.parameters or {}).get("unregister_timeout")
    if timeout is not None:
        manager.unregister_timeout = timeout
