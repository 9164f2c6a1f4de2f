"""The formats of what is printed and logged."""

from __future__ import annotations

import logging
import os
import sys
import zlib
from typing import Literal

Style = Literal["%", "{", "$"]
"""How a format names its fields; see `logging.Formatter`."""

_SCREEN_FORMATS = {
    "default": "[{levelname}] [{name}]: {message}",
    "default_with_timestamp": "{created:.7f} [{levelname}] [{name}]: {message}",
}
_LOG_FORMATS = {"default": "{created:.7f} [{levelname}] [{name}]: {message}"}

_RESET = "\033[0m"
_LEVEL_COLORS = {"DEBUG": "\033[32m", "WARNING": "\033[33m", "ERROR": "\033[31m", "CRITICAL": "\033[1;31m"}
_PROCESS_COLORS = [f"\033[{code}m" for code in (36, 35, 34, 96, 95, 94)]


def screen_formatter(screen_format: str, style: Style | None) -> logging.Formatter:
    """Return the formatter of what launch itself prints, in colour on a terminal.

    Raises
    ------
    ValueError
        If a style is given for one of the standard formats.
    """
    text, style = _choose(screen_format, style, _SCREEN_FORMATS)
    return (
        _ColoredLevels(text, style=style) if screen_format in _SCREEN_FORMATS else logging.Formatter(text, style=style)
    )


def log_formatter(log_format: str, style: Style | None) -> logging.Formatter:
    """Return the formatter of the main log file.

    Raises
    ------
    ValueError
        If a style is given for one of the standard formats.
    """
    text, style = _choose(log_format, style, _LOG_FORMATS)
    return logging.Formatter(text, style=style)


def output_screen_formatter() -> logging.Formatter:
    """Return the formatter of what processes print: as it is, the prefix in colour on a terminal."""
    return _ColoredPrefix()


def _choose(name: str, style: Style | None, standard: dict[str, str]) -> tuple[str, Style]:
    if name in standard:
        if style is not None:
            raise ValueError(f"the format '{name}' has its own style; '{style}' cannot be set for it")
        return standard[name], "{"
    return name, style or "{"


def _in_color() -> bool:
    return sys.stdout is not None and sys.stdout.isatty() and not os.environ.get("NO_COLOR")


class _ColoredLevels(logging.Formatter):
    def format(self, record: logging.LogRecord) -> str:
        text = super().format(record)
        color = _LEVEL_COLORS.get(record.levelname)
        if color is None or not _in_color():
            return text
        level = f"[{record.levelname}]"
        return text.replace(level, f"{color}{level}{_RESET}", 1)


class _ColoredPrefix(logging.Formatter):
    def format(self, record: logging.LogRecord) -> str:
        text = super().format(record)
        prefix, bracket, rest = text.partition("] ")
        if not (bracket and prefix.startswith("[") and _in_color()):
            return text
        # The same process has the same colour in every launch.
        color = _PROCESS_COLORS[zlib.crc32(prefix.rsplit("-", 1)[0].encode()) % len(_PROCESS_COLORS)]
        return f"{color}{prefix}]{_RESET} {rest}"
