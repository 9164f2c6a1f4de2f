"""Message on its way to clients, whose encodings are made once for all of them."""

from __future__ import annotations

from functools import cached_property
from typing import Any

from rclpy.serialization import deserialize_message

from rosbridge_library.internal.cbor_conversion import extract_cbor_values
from rosbridge_library.internal.message_conversion import extract_values
from rosbridge_library.util.cbor import dumps


class OutgoingMessage:
    """Message with its encodings.

    Parameters
    ----------
    message
        The message, or its bytes.
    msg_class
        Class of the message where it is bytes.
    """

    def __init__(self, message: Any, msg_class: Any = None) -> None:
        self._given = message
        self._class = msg_class

    @property
    def message(self) -> Any:
        """The message as it was given."""
        return self._given

    @cached_property
    def _decoded(self) -> Any:
        return self._given if self._class is None else deserialize_message(self._given, self._class)

    @cached_property
    def _json_values(self) -> dict[str, Any]:
        return extract_values(self._decoded)

    @cached_property
    def _cbor_values(self) -> dict[str, Any]:
        return extract_cbor_values(self._decoded)

    @cached_property
    def _frames(self) -> dict[str, bytes]:
        return {}

    def get_json_values(self) -> dict[str, Any]:
        """Return the fields as values for JSON."""
        return self._json_values

    def get_cbor_values(self) -> dict[str, Any]:
        """Return the fields as values for CBOR."""
        return self._cbor_values

    def get_cbor(self, outgoing_msg: dict[str, Any]) -> bytes:
        """Return a frame in CBOR whose ``msg`` holds the fields; the first one is kept for all clients."""
        if "cbor" not in self._frames:
            self._frames["cbor"] = dumps({**outgoing_msg, "msg": self._cbor_values})
        return self._frames["cbor"]

    def get_cbor_raw(self, outgoing_msg: dict[str, Any]) -> bytes:
        """Return a frame in CBOR whose ``msg`` is given; the first one is kept for all clients."""
        if "cbor-raw" not in self._frames:
            self._frames["cbor-raw"] = dumps(outgoing_msg)
        return self._frames["cbor-raw"]
