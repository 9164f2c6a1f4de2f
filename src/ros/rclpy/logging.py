"""Logging: get a logger, set levels."""

from __future__ import annotations

from pathlib import Path

from rclpy.impl.log_output import OUTPUT, log_directory
from rclpy.impl.logging_severity import LoggingSeverity
from rclpy.impl.rcutils_logger import RcutilsLogger

__all__ = [
    "LoggingSeverity",
    "clear_config",
    "get_logger",
    "get_logger_effective_level",
    "get_logger_level",
    "get_logging_directory",
    "get_logging_severity_from_string",
    "initialize",
    "set_logger_level",
    "shutdown",
]


_root_logger = RcutilsLogger()


def get_logger(name: str) -> RcutilsLogger:
    """Return the logger of that name.

    Raises
    ------
    ValueError
        For an empty name.
    """
    if not name:
        raise ValueError("Logger name must not be empty.")
    return RcutilsLogger(name=name)


def initialize() -> None:
    """Accept the call without effect: logging is ready from the start."""


def shutdown() -> None:
    """Close the log file."""
    OUTPUT.close()


def clear_config() -> None:
    """Reset levels and outputs to those of the start."""
    OUTPUT.close()
    OUTPUT.reset()


def set_logger_level(name: str, level: int | LoggingSeverity, detailed_error: bool = False) -> None:
    """Set the level of a logger ("" for the default)."""
    OUTPUT.set_level(name, LoggingSeverity(level))


def get_logger_effective_level(name: str) -> LoggingSeverity:
    """Return the level that applies to a logger."""
    return OUTPUT.effective_level(name)


def get_logger_level(name: str) -> LoggingSeverity:
    """Return the level set for exactly this logger; UNSET if none is."""
    return OUTPUT.level_of(name)


def get_logging_severity_from_string(log_severity: str) -> LoggingSeverity:
    """Return the severity with that name, in upper or lower case.

    Raises
    ------
    RuntimeError
        When there is none.
    """
    try:
        return LoggingSeverity[log_severity.upper()]
    except KeyError:
        raise RuntimeError(
            f"'{log_severity}' is not a severity; expected one of {', '.join(LoggingSeverity.__members__)}"
        ) from None


def get_logging_directory() -> Path:
    """Return the folder of log files."""
    return log_directory()
