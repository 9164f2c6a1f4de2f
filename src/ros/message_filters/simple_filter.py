"""Common base of filters: callbacks for the output."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import Any


class SimpleFilter:
    """Base of filters.

    Attributes
    ----------
    callbacks
        Functions with their additional arguments, by connection.
    """

    def __init__(self) -> None:
        self.callbacks: dict[int, tuple[Callable[..., Any], tuple[Any, ...]]] = {}
        self._number = itertools.count().__next__

    def registerCallback(self, cb: Callable[..., Any], *args: Any) -> int:
        """Call ``cb(*messages, *args)`` with everything the filter puts out, and return the connection."""
        connection = self._number()
        self.callbacks[connection] = (cb, args)
        return connection

    def unregisterCallback(self, conn: int) -> None:
        """Disconnect a callback."""
        self.callbacks.pop(conn, None)

    def signalMessage(self, *msg: Any) -> None:
        """Pass a message, or several that belong together, to the callbacks."""
        for callback, arguments in list(self.callbacks.values()):
            callback(*msg, *arguments)
