"""Messages of the client that come in pieces."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from rosbridge_library.capability import Capability, Field

if TYPE_CHECKING:
    from rosbridge_library.protocol import Protocol

_MAX_PIECES = 65536
_MAX_CHARACTERS = 64 << 20


@dataclass
class _Pieces:
    total: int
    last_ns: int = 0
    received: dict[int, str] = field(default_factory=dict)


class Defragment(Capability):
    """Operation ``fragment``: pieces are kept until their message is complete, or none came for a time."""

    fragment_timeout: float = 600.0
    """That time, in seconds."""
    opcode = "fragment"
    fields: tuple[Field, ...] = (
        (True, "id", (str, int)),
        (True, "num", int),
        (True, "total", int),
        (True, "data", str),
    )

    def __init__(self, protocol: Protocol) -> None:
        super().__init__(protocol)
        self.fragment_timeout = (protocol.parameters or {}).get("fragment_timeout", self.fragment_timeout)
        self.received_fragments: dict[str | int, _Pieces] = {}
        protocol.register_operation(self.opcode, self.defragment)

    def defragment(self, message: dict[str, Any]) -> None:
        """Keep a piece, and carry out the message that it completes."""
        self.basic_type_check(message, self.fields)
        number, num, total, data = (message[name] for name in ("id", "num", "total", "data"))
        self._forget_old(time.monotonic_ns())
        if not 0 <= num < total <= _MAX_PIECES:
            raise ValueError(f"piece {num} of {total}, expected one from 0 on of at most {_MAX_PIECES}")
        pieces = self.received_fragments.get(number)
        if pieces is None:
            self.check_room(len(self.received_fragments), "messages in pieces that are not complete")
            pieces = self.received_fragments[number] = _Pieces(total)
        if pieces.total != total or pieces.received.get(num, data) != data:
            raise ValueError(f"piece {num} of {total} does not belong to the earlier pieces of message {number!r}")
        if self._held() + len(data) > _MAX_CHARACTERS:
            del self.received_fragments[number]
            raise ValueError(f"more than {_MAX_CHARACTERS} characters in pieces")
        pieces.received[num] = data
        pieces.last_ns = time.monotonic_ns()
        if len(pieces.received) == total:
            del self.received_fragments[number]
            self.protocol.incoming("".join(pieces.received[at] for at in range(total)))

    def _held(self) -> int:
        return sum(len(data) for pieces in self.received_fragments.values() for data in pieces.received.values())

    def _forget_old(self, now_ns: int) -> None:
        limit_ns = int(self.fragment_timeout * 1e9)
        old = [number for number, one in self.received_fragments.items() if now_ns - one.last_ns > limit_ns]
        for number in old:
            missing = self.received_fragments.pop(number)
            self.protocol.log(
                "warning",
                f"{len(missing.received)} of {missing.total} pieces of message {number!r} came in "
                f"{self.fragment_timeout:g} s; they are dropped",
            )

    def finish(self) -> None:
        """Drop the pieces."""
        self.received_fragments.clear()
        self.protocol.unregister_operation(self.opcode)
