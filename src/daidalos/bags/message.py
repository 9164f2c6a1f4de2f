"""Content of bags: topics and serialized messages."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from daidalos.transport.qos import Qos

SERVICE_EVENTS = "/_service_event"


@dataclass(frozen=True)
class Definition:
    """Text that defines a message type with all its dependencies, and the encoding of that text."""

    text: str
    encoding: str = "ros2msg"


@dataclass(frozen=True)
class Topic:
    """Topic of a bag.

    Attributes
    ----------
    name, type
        Such as ``/chatter`` and ``std_msgs/msg/String``.
    serialization_format
        How its messages are serialized.
    qos
        What its publishers offered.
    type_hash
        ``RIHS01_...``; empty where it is not known.
    definition
        The type's definition, None where it is not known.
    """

    name: str
    type: str
    serialization_format: str = "cdr"
    qos: tuple[Qos, ...] = ()
    type_hash: str = ""
    definition: Definition | None = None

    @property
    def is_service_event(self) -> bool:
        """Whether the topic carries service events."""
        return is_service_event(self.name, self.type)

    @property
    def service_name(self) -> str:
        """Name of the service that the events belong to."""
        return self.name.removesuffix(SERVICE_EVENTS)

    @property
    def service_type(self) -> str:
        """Type of the service that the events belong to."""
        return self.type.removesuffix("_Event")


def is_service_event(name: str, type_name: str) -> bool:
    """Return whether a topic carries service events."""
    return name.endswith(SERVICE_EVENTS) and "/srv/" in type_name and type_name.endswith("_Event")


class BagMessage(NamedTuple):
    """Message as recorded; times are Unix time or robot time in nanoseconds."""

    topic: str
    data: bytes
    received_ns: int
    sent_ns: int
