"""Outputs of log messages: console, log file and further callbacks (``/rosout``).

Formats, colours, environment variables and file names are those of rcutils and rcl_logging_spdlog.
"""

from __future__ import annotations

import functools
import os
import sys
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import IO

from rclpy.impl.logging_severity import LoggingSeverity

_DEFAULT_FORMAT = "[{severity}] [{time}] [{name}]: {message}"
_COLOURS = {
    LoggingSeverity.DEBUG: "\033[32m",
    LoggingSeverity.INFO: "",
    LoggingSeverity.WARN: "\033[33m",
    LoggingSeverity.ERROR: "\033[31m",
    LoggingSeverity.FATAL: "\033[31m",
}
_RESET = "\033[0m"


@dataclass(frozen=True, slots=True)
class Record:
    """One log message; `stamp_ns` is Unix time."""

    severity: LoggingSeverity
    name: str
    message: str
    stamp_ns: int
    function: str
    file: str
    line: int


class Output:
    """Levels of loggers, and the outputs that every message goes to."""

    def __init__(self) -> None:
        self._lock = threading.RLock()
        self.reset()

    def reset(self) -> None:
        """Read all settings from the environment again."""
        self.levels: dict[str, LoggingSeverity] = {}
        self.default_level = LoggingSeverity.INFO
        self.to_console = True
        self.to_file = True
        self.relative_sources = False
        self.file_stem = ""
        self.handlers: dict[str, Callable[[], Callable[[Record], None] | None]] = {}
        self._format = os.environ.get("RCUTILS_CONSOLE_OUTPUT_FORMAT") or _DEFAULT_FORMAT
        self._use_stdout = os.environ.get("RCUTILS_LOGGING_USE_STDOUT") == "1"
        self._file: IO[str] | None = None

    def source_file(self, path: str) -> str:
        """Return how messages name the source file of a call: relative to ``sys.path`` if `relative_sources` is set."""
        return _relative_to_path(path) if self.relative_sources else path

    def level_of(self, name: str) -> LoggingSeverity:
        """Return the level set for exactly this logger, UNSET if none is."""
        return self.levels.get(name, LoggingSeverity.UNSET) if name else self.default_level

    def set_level(self, name: str, level: LoggingSeverity) -> None:
        """Set a logger's level; UNSET makes it follow its ancestors again, and the root log everything."""
        if not name:
            self.default_level = level
        elif level:
            self.levels[name] = level
        else:
            self.levels.pop(name, None)

    def effective_level(self, name: str) -> LoggingSeverity:
        """Return the level that applies to a logger: its own, its nearest ancestor's or the default."""
        if self.levels:
            while name:
                level = self.levels.get(name)
                if level:
                    return level
                name = name.rpartition(".")[0]
        return self.default_level

    def write(self, record: Record) -> None:
        """Send a message, already found important enough, everywhere."""
        with self._lock:
            if self.to_console:
                self._write_console(record)
            if self.to_file:
                self._write_file(record)
        handler = self._handler_of(record.name)
        if handler:
            handler(record)

    def _handler_of(self, name: str) -> Callable[[Record], None] | None:
        while name:
            if name in self.handlers:
                return self.handlers[name]()
            name = name.rpartition(".")[0]
        return None

    def _write_console(self, record: Record) -> None:
        stream = sys.stdout if self._use_stdout else sys.stderr
        if stream is None:
            return
        text = _formatted(self._format, record)
        colour = _COLOURS[record.severity] if _wants_colour(stream) else ""
        try:
            stream.write(f"{colour}{text}{_RESET if colour else ''}\n")
            stream.flush()
        except (BrokenPipeError, ValueError):
            self.to_console = False  # nobody reads any more

    def _write_file(self, record: Record) -> None:
        if self._file is None:
            try:
                self._file = self._open_file()
            except OSError as error:
                self.to_file = False
                print(f"cannot write log files: {error}", file=sys.stderr)  # noqa: T201
                return
        self._file.write(_formatted(_DEFAULT_FORMAT, record) + "\n")
        if record.severity >= LoggingSeverity.WARN:
            self._file.flush()

    def _open_file(self) -> IO[str]:
        folder = log_directory()
        folder.mkdir(parents=True, exist_ok=True)
        stem = self.file_stem or Path(sys.argv[0] or "python").stem
        path = folder / f"{stem}_{os.getpid()}_{time.time_ns() // 1_000_000}.log"
        return path.open("w", encoding="utf-8", errors="backslashreplace")

    def close(self) -> None:
        """Close the log file."""
        with self._lock:
            file, self._file = self._file, None
            if file:
                file.close()


def log_directory() -> Path:
    """Return the folder of log files: ``ROS_LOG_DIR``, or ``log`` in ``ROS_HOME`` or ``~/.ros``."""
    folder = os.environ.get("ROS_LOG_DIR")
    if folder:
        return Path(folder).expanduser()
    home = os.environ.get("ROS_HOME")
    return (Path(home).expanduser() if home else Path.home() / ".ros") / "log"


def _wants_colour(stream: IO[str]) -> bool:
    wish = os.environ.get("RCUTILS_COLORIZED_OUTPUT")
    return wish == "1" if wish in ("0", "1") else stream.isatty()


@functools.cache
def _relative_to_path(file: str) -> str:
    """Return a file's path relative to the folder that it is imported from; only its name where that is none."""
    folders = [folder for folder in map(os.path.abspath, sys.path) if file.startswith(os.path.join(folder, ""))]
    longest = max(folders, key=len, default=os.path.dirname(file))
    return Path(os.path.relpath(file, longest)).as_posix()


def _formatted(template: str, record: Record) -> str:
    if template is _DEFAULT_FORMAT:
        seconds, ns = divmod(record.stamp_ns, 1_000_000_000)
        return f"[{record.severity.name}] [{seconds}.{ns:09}] [{record.name}]: {record.message}"
    seconds, ns = divmod(record.stamp_ns, 1_000_000_000)
    values = {
        "severity": record.severity.name,
        "name": record.name,
        "message": record.message,
        "function_name": record.function,
        "file_name": record.file,
        "line_number": str(record.line),
        "time": f"{seconds}.{ns:09}",
        "time_as_nanoseconds": str(record.stamp_ns),
        "date_time_with_ms": time.strftime("%Y-%m-%d %H:%M:%S", time.localtime(seconds)) + f".{ns // 1_000_000:03}",
    }
    for key, value in values.items():
        template = template.replace("{" + key + "}", value)
    return template


OUTPUT = Output()
