"""Messages of state machines, which go to the terminal until other functions are set."""

from __future__ import annotations

from collections.abc import Callable

Logger = Callable[[str], object]


def _printer(level: str) -> Logger:
    return lambda message: print(f"[{level:^7}] : {message}")  # noqa: T201


_loggers: dict[str, Logger] = {level: _printer(level) for level in ("DEBUG", "INFO", "WARN", "ERROR")}


def set_loggers(info: Logger, warn: Logger, debug: Logger, error: Logger) -> None:
    """Set the functions that take messages."""
    _loggers.update(INFO=info, WARN=warn, DEBUG=debug, ERROR=error)


def logdebug(msg: object) -> None:
    """Log a message for debugging."""
    _loggers["DEBUG"](str(msg))


def loginfo(msg: object) -> None:
    """Log a message."""
    _loggers["INFO"](str(msg))


def logwarn(msg: object) -> None:
    """Log a warning."""
    _loggers["WARN"](str(msg))


def logerr(msg: object) -> None:
    """Log an error."""
    _loggers["ERROR"](str(msg))
