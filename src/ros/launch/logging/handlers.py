"""Log handlers that write the records of each logger in that logger's own format."""

from __future__ import annotations

import logging
import sys
from typing import Any

__all__ = ["FileHandler", "Handler", "StreamHandler", "with_per_logger_formatting"]


def with_per_logger_formatting(cls: type[Any]) -> type[Any]:
    """Return a subclass of a handler class that keeps a formatter for each logger.

    Parameters
    ----------
    cls
        A subclass of `logging.Handler`.
    """

    class PerLoggerFormattingHandler(cls):  # type: ignore[misc]  # the base is known when it is called
        """A log handler with a formatter for each logger and one for all others."""

        def __init__(self, *args: Any, **kwargs: Any) -> None:
            super().__init__(*args, **kwargs)
            self._formatters: dict[str, logging.Formatter] = {}

        def setFormatterFor(self, logger: logging.Logger, formatter: logging.Formatter) -> None:
            """Set the formatter for one logger's records."""
            self._formatters[logger.name] = formatter

        def unsetFormatterFor(self, logger: logging.Logger) -> None:
            """Format one logger's records like all others again."""
            self._formatters.pop(logger.name, None)

        def format(self, record: logging.LogRecord) -> str:
            """Format a record."""
            formatter = self._formatters.get(record.name)
            return super().format(record) if formatter is None else formatter.format(record)

    PerLoggerFormattingHandler.__name__ = cls.__name__
    PerLoggerFormattingHandler.__qualname__ = cls.__qualname__
    PerLoggerFormattingHandler.__doc__ = cls.__doc__
    return PerLoggerFormattingHandler


Handler = with_per_logger_formatting(logging.Handler)


class _ReadStreamHandler(logging.StreamHandler[Any]):
    """Handler that writes to a stream as long as it is read: a launch goes on when ``| head`` has seen enough."""

    _is_read = True

    def emit(self, record: logging.LogRecord) -> None:
        """Write a record."""
        if self._is_read:
            super().emit(record)

    def flush(self) -> None:
        """Write what waits to be written."""
        if self._is_read:
            super().flush()

    def handleError(self, record: logging.LogRecord) -> None:
        """Report an error, unless the stream is no longer read."""
        if isinstance(sys.exc_info()[1], BrokenPipeError):
            self._is_read = False
        else:
            super().handleError(record)


StreamHandler = with_per_logger_formatting(_ReadStreamHandler)
FileHandler = with_per_logger_formatting(logging.FileHandler)
