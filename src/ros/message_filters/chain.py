"""Filters one after the other."""

from __future__ import annotations

from typing import Any

from .simple_filter import SimpleFilter


class Chain(SimpleFilter):
    """Filter made of any number of filters, one after another.

    Parameters
    ----------
    message_filter
        The filter to listen to.
    """

    def __init__(self, message_filter: SimpleFilter | None = None) -> None:
        super().__init__()
        self.incoming_connection: int | None = None
        self._filters: list[Any] = []
        self._output_connection = 0
        if message_filter is not None:
            self.connectInput(message_filter)

    def connectInput(self, message_filter: SimpleFilter) -> None:
        """Listen to a filter.

        Raises
        ------
        RuntimeError
            When it listens to one already.
        """
        if self.incoming_connection is not None:
            raise RuntimeError("Already connected")
        self.incoming_connection = message_filter.registerCallback(self.add)

    def add(self, message: Any) -> None:
        """Process a message."""
        if self._filters:
            self._filters[0].add(message)
        else:
            self.signalMessage(message)

    def addFilter(self, message_filter: Any) -> None:
        """Append a filter, which has a method ``add``."""
        if self._filters:
            last = self._filters[-1]
            last.unregisterCallback(self._output_connection)
            last.registerCallback(message_filter.add)
        self._output_connection = message_filter.registerCallback(self.signalMessage)
        self._filters.append(message_filter)

    def getFilter(self, index: int) -> Any:
        """Return a filter by its place.

        Raises
        ------
        KeyError
            When there is none.
        """
        if not 0 <= index < len(self._filters):
            raise KeyError(index)
        return self._filters[index]
