"""Messages of the client in the pixels of a picture."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosbridge_library.capability import Capability, Field
from rosbridge_library.internal.pngcompression import decode

if TYPE_CHECKING:
    from rosbridge_library.protocol import Protocol


class Png(Capability):
    """Operation ``png``: its data is a message, or a piece of one."""

    fields: tuple[Field, ...] = ((True, "data", str),)

    def __init__(self, protocol: Protocol) -> None:
        super().__init__(protocol)
        protocol.register_operation("png", self.unpack)

    def unpack(self, message: dict[str, Any]) -> None:
        """Carry out the message of a picture."""
        self.basic_type_check(message, self.fields)
        inner = decode(message["data"])
        if self.protocol.deserialize(inner).get("op") == "png":
            raise ValueError("the message of a picture is one of a picture itself")
        self.protocol.incoming(inner)
