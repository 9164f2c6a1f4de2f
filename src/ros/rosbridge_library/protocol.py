"""One client's side of the protocol: its messages come in, and messages for it go out."""

from __future__ import annotations

import json
from collections.abc import Callable, Hashable, Mapping, Sequence
from typing import Any, ClassVar

from rclpy.node import Node

from rosbridge_library.capabilities.fragmentation import Fragmentation
from rosbridge_library.capability import Capability

LEVELS = {"info": 0, "warning": 1, "error": 2, "none": 3}
"""Levels of status messages; a client gets those from its own level on."""
_SHORT_LEVELS = {"err": "error", "warn": "warning", "information": "info"}
_BINARY = ("cbor", "cbor-raw")
_MAX_SHOWN = 200


class Protocol:
    """A client of the graph.

    Messages of the client go to `incoming`; `outgoing` is to be replaced by what sends messages to it; `finish` closes
    what the client opened.

    Parameters
    ----------
    client_id
        Identifies the client among those of this process.
    node_handle
        Node that publishes, subscribes and calls for the client.

    Attributes
    ----------
    fragment_size
        Characters of a message to the client; longer ones are sent in pieces. None sends all as they are.
    delay_between_messages
        Time between two messages to the client, in seconds, which its sender keeps.
    status_level
        Level of `LEVELS` from which the client gets status messages; none where it has not asked for them, since
        many clients do not know them.
    max_held
        How many topics, services, calls and the like the client may have of each kind.
    """

    external_service_list: ClassVar[dict[str, Any]] = {}
    """Services that clients offer, by name."""
    external_action_list: ClassVar[dict[str, Any]] = {}
    """Actions that clients offer, by name."""
    abandoned: ClassVar[type[Exception]] = RuntimeError
    """Error that ends a request to a client which no longer offers the service."""
    parameters: Mapping[str, Any] | None = None
    max_held = 256

    def __init__(self, client_id: Hashable, node_handle: Node) -> None:
        self.client_id = client_id
        self.node_handle = node_handle
        self.capabilities: list[Capability] = []
        self.operations: dict[str, Callable[[dict[str, Any]], Any]] = {"set_level": self.set_level}
        self.operations["status_level"] = self.set_level
        given = self.parameters or {}
        self.fragment_size: int | None = given.get("fragment_size")
        self.delay_between_messages: float = given.get("delay_between_messages", 0.0)
        self.status_level = "none"

    def incoming(self, message_string: str | bytes = "") -> None:
        """Carry out a message of the client; what is wrong with it is logged, and told as a status message."""
        try:
            message = self.deserialize(message_string)
        except (ValueError, RecursionError) as error:
            self.log("error", f"expected a message in JSON: {error}")
            return
        if not isinstance(message, dict):
            self.log("error", "expected a JSON object with the field 'op'")
            return
        given = message.get("id")
        carry_out = self.operations.get(message["op"]) if isinstance(message.get("op"), str) else None
        if carry_out is None:
            known = ", ".join(sorted(self.operations))
            found = "no field 'op'" if "op" not in message else f"op {str(message['op'])[:_MAX_SHOWN]!r}"
            self.log("error", f"{found}, expected one of: {known}", given)
            return
        try:
            self._set_pace(message)
            carry_out(message)
        except Exception as error:  # whatever the client sent
            self.log("error", f"{message['op']}: {error}", given)

    def _set_pace(self, message: dict[str, Any]) -> None:
        size, delay = message.get("fragment_size"), message.get("message_intervall")
        if isinstance(size, int) and size > 0:
            self.fragment_size = size
        if isinstance(delay, int | float) and 0 <= delay <= 60:  # NaN is neither
            self.delay_between_messages = float(delay)

    def set_level(self, message: dict[str, Any]) -> None:
        """Set the level from which the client gets status messages."""
        level = message.get("level")
        if level not in LEVELS:
            raise ValueError(f"expected a level of {', '.join(LEVELS)}, got {level!r:.100}")
        self.status_level = level

    def outgoing(self, message: str | bytes, compression: str = "none") -> None:
        """Send a message to the client; to be replaced."""

    def outgoing_publication(self, topic: str, frames: Sequence[str | bytes], compression: str = "none") -> None:
        """Send a message of a topic, in one frame or in pieces; older ones may be left out for a slow client."""
        for frame in frames:
            self.outgoing(frame, compression)

    def close_publication(self, topic: str) -> None:
        """Forget the messages of a topic that wait: the client wants them no longer."""

    def send(self, message: Any, cid: Any = None, compression: str = "none", topic: str | None = None) -> None:
        """Send a message to the client, in pieces where it is longer than `fragment_size`.

        Parameters
        ----------
        message
            Fields and values, or a frame in CBOR.
        cid
            The id of the request that it answers, for the log.
        compression
            How the client wants it.
        topic
            Topic of a published message; None for others.
        """
        frame = message if compression in _BINARY else self.serialize(message, cid)
        if frame is None:
            return
        frames = [frame]
        if isinstance(frame, str) and self.fragment_size is not None and len(frame) > self.fragment_size:
            pieces = Fragmentation(self).fragment(message, self.fragment_size, message.get("id"))
            frames = [json.dumps(piece) for piece in pieces]
        if topic is not None:
            self.outgoing_publication(topic, frames, compression)
            return
        for one in frames:
            self.outgoing(one, compression)

    def finish(self) -> None:
        """Close what the client opened: it has left."""
        for capability in self.capabilities:
            capability.finish()

    def serialize(self, msg: Any, cid: Any = None) -> str | None:
        """Return a message in JSON; None where it cannot be, which is logged."""
        try:
            return json.dumps(msg, separators=(",", ":"))
        except (TypeError, ValueError, RecursionError) as error:
            self.log("error", f"a message cannot be sent: {error}", cid)
            return None

    def deserialize(self, msg: str | bytes, cid: Any = None) -> Any:
        """Return the values of a message in JSON."""
        return json.loads(msg)

    def register_operation(self, opcode: str, handler: Callable[[dict[str, Any]], Any]) -> None:
        """Add an operation."""
        self.operations[opcode] = handler

    def unregister_operation(self, opcode: str) -> None:
        """Remove an operation, where it is one."""
        self.operations.pop(opcode, None)

    def add_capability(self, capability_class: Callable[[Protocol], Capability]) -> None:
        """Add the operations of a class."""
        self.capabilities.append(capability_class(self))

    def log(self, level: str, message: str, lid: Any = None) -> None:
        """Log a message about the client, and send it as a status message where the client asked for its level."""
        level = _SHORT_LEVELS.get(level, level)
        given = "" if lid is None else f"[id: {str(lid)[:_MAX_SHOWN]}] "
        self._write(level, f"[Client {self.client_id}] {given}{message}")
        if level in LEVELS and LEVELS[level] >= LEVELS[self.status_level]:
            status = {"op": "status", "level": level, "msg": message}
            self.outgoing(json.dumps(status if lid is None else {**status, "id": lid}))

    def _write(self, level: str, text: str) -> None:
        logger = self.node_handle.get_logger()
        write = {"error": logger.error, "warning": logger.warning, "info": logger.info}.get(level, logger.debug)
        write(text.encode("utf-8", "backslashreplace").decode())  # a lone surrogate cannot be sent to /rosout
