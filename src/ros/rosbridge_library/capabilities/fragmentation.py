"""Long messages in pieces."""

from __future__ import annotations

import itertools
from typing import Any

from rosbridge_library.capability import Capability

_MAX_PIECES = 4096
_numbers = itertools.count()


class Fragmentation(Capability):
    """Division of a message to the client."""

    def fragment(self, message: dict[str, Any], fragment_size: int, mid: Any = None) -> list[dict[str, Any]]:
        """Return the pieces of a message.

        Parameters
        ----------
        message
            Fields and values.
        fragment_size
            Characters of a piece; more where there would be thousands of them.
        mid
            Id of the pieces; None for a new one.

        Returns
        -------
        list of dict
            The pieces; the message itself where it is no longer than one.
        """
        text = self.protocol.serialize(message, mid)
        if text is None:
            return []
        size = max(fragment_size, -(-len(text) // _MAX_PIECES), 1)
        if len(text) <= size:
            return [message]
        number = next(_numbers) if mid is None else mid
        pieces = [text[at : at + size] for at in range(0, len(text), size)]
        return [
            {"op": "fragment", "id": number, "data": piece, "num": num, "total": len(pieces)}
            for num, piece in enumerate(pieces)
        ]
