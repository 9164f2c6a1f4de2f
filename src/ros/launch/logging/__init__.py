"""Output of launch and its processes: screen, main log file and log files of their own.

`launch_config` is where all of it is configured. The files lie in a folder of their own for each launch,
below `$ROS_LOG_DIR`, `$ROS_HOME/log` or `~/.ros/log`.
"""

from __future__ import annotations

import logging
import os
import sys
from collections.abc import Callable, Mapping
from typing import Any, ClassVar

from . import handlers
from ._formats import Style, log_formatter, output_screen_formatter, screen_formatter
from ._log_dir import create_log_dir, get_logging_directory, link_latest

__all__ = [
    "LaunchConfig",
    "LaunchLogger",
    "get_logger",
    "get_logging_directory",
    "get_output_loggers",
    "handlers",
    "launch_config",
    "log_launch_config",
    "reset",
]

_get_logging_directory = get_logging_directory


def _make_unique_log_dir(*, base_path: str) -> str:
    return create_log_dir(base_path)


def _renew_latest_log_dir(*, log_dir: str) -> bool:
    return link_latest(log_dir)


_STANDARD_OUTPUTS: dict[str, dict[str, set[str]]] = {
    "screen": {"both": {"screen"}},
    "log": {"both": {"log"}, "stderr": {"screen"}},
    "both": {"both": {"log", "screen"}},
    "own_log": {"both": {"own_log"}, "stdout": {"own_log"}, "stderr": {"own_log"}},
    "full": {"both": {"screen", "log", "own_log"}, "stdout": {"own_log"}, "stderr": {"own_log"}},
}
_SOURCES = ("both", "stdout", "stderr")
_DESTINATIONS = frozenset({"screen", "log", "own_log"})


class LaunchConfig:
    """The configuration of launch's logging."""

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """Restore the defaults; handlers are created anew."""
        self._log_dir: str | None = None
        self._screen_handler: Any = None
        self._file_handlers: dict[str, Any] = {}
        self._log_handler_factory: Callable[..., logging.Handler] = handlers.FileHandler
        self.level = logging.INFO
        self.set_screen_format("default")
        self.set_log_format("default")

    @property
    def level(self) -> int:
        """The level below which nothing is logged."""
        return logging.root.level

    @level.setter
    def level(self, new_level: int | str) -> None:
        logging.root.setLevel(new_level)

    @property
    def log_dir(self) -> str:
        """The folder of the log files; it is made when first asked for."""
        if self._log_dir is None:
            self._log_dir = _make_unique_log_dir(base_path=get_logging_directory())
            _renew_latest_log_dir(log_dir=self._log_dir)
        return self._log_dir

    @log_dir.setter
    def log_dir(self, new_log_dir: str | None) -> None:
        if new_log_dir is None:  # another is made when it is asked for
            self._log_dir = None
            return
        folder = os.path.abspath(new_log_dir)
        if self._file_handlers:
            raise RuntimeError("the log folder cannot be changed once log files were opened in it")
        if not (os.path.isdir(folder) and os.access(folder, os.W_OK)):
            raise ValueError(f"'{folder}' is not a folder that can be written to")
        self._log_dir = folder

    @property
    def log_handler_factory(self) -> Callable[..., logging.Handler]:
        """Makes the handler of a log file, given its path and an encoding."""
        return self._log_handler_factory

    @log_handler_factory.setter
    def log_handler_factory(self, factory: Callable[..., logging.Handler]) -> None:
        self._log_handler_factory = factory

    def set_screen_format(self, screen_format: str, *, screen_style: Style | None = None) -> None:
        """Set the format of what is printed.

        Parameters
        ----------
        screen_format
            'default', 'default_with_timestamp' or a format of the `logging` module. The environment variable
            OVERRIDE_LAUNCH_SCREEN_FORMAT comes before it.
        screen_style
            The style of a format of one's own, '{' if not given.
        """
        screen_format = os.environ.get("OVERRIDE_LAUNCH_SCREEN_FORMAT", screen_format)
        self._screen_formatter = screen_formatter(screen_format, screen_style)
        if self._screen_handler is not None:
            self._screen_handler.setFormatter(self._screen_formatter)

    def get_screen_handler(self) -> Any:
        """Return the one handler that prints."""
        if self._screen_handler is None:
            self._screen_handler = handlers.StreamHandler(sys.stdout)
            self._screen_handler.setFormatter(self._screen_formatter)
        return self._screen_handler

    def set_log_format(self, log_format: str, *, log_style: Style | None = None) -> None:
        """Set the format of the main log file.

        Parameters
        ----------
        log_format
            'default' or a format of the `logging` module. The environment variable OVERRIDE_LAUNCH_LOG_FORMAT
            comes before it.
        log_style
            The style of a format of one's own, '{' if not given.
        """
        log_format = os.environ.get("OVERRIDE_LAUNCH_LOG_FORMAT", log_format)
        self._log_formatter = log_formatter(log_format, log_style)
        for handler in self._file_handlers.values():
            handler.setFormatter(self._log_formatter)

    def get_log_file_path(self, file_name: str = "launch.log") -> str:
        """Return the path of a log file."""
        return os.path.join(self.log_dir, file_name)

    def get_log_file_handler(self, file_name: str = "launch.log") -> Any:
        """Return the one handler that writes a log file."""
        if file_name not in self._file_handlers:
            handler = self.log_handler_factory(self.get_log_file_path(file_name), encoding="utf-8")
            handler.setFormatter(self._log_formatter)
            self._file_handlers[file_name] = handler
        return self._file_handlers[file_name]


class LaunchLogger(logging.Logger):
    """A logger of launch; it does not hand its records on to the loggers above it."""

    all_loggers: ClassVar[list[LaunchLogger]] = []

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.propagate = False
        LaunchLogger.all_loggers.append(self)


launch_config = LaunchConfig()


def log_launch_config(*, logger: logging.Logger = logging.root) -> None:
    """Log where the log files are and what is logged."""
    logger.info(f"All log files can be found below {launch_config.log_dir}")
    logger.info(f"Default logging verbosity is set to {logging.getLevelName(launch_config.level)}")


def get_logger(name: str | None = None) -> logging.Logger:
    """Return a logger that prints and writes the main log file."""
    logger = _launch_logger(name)
    _add_handler(logger, launch_config.get_screen_handler())
    _add_handler(logger, launch_config.get_log_file_handler())
    return logger


def get_output_loggers(
    process_name: str, output_config: str | Mapping[str, str | set[str]]
) -> tuple[logging.Logger, logging.Logger]:
    """Return the loggers for the standard output and the standard error of a process.

    Parameters
    ----------
    process_name
        Names the loggers and the process's own log files.
    output_config
        'screen', 'log' (errors also to the screen), 'both', 'own_log' (files of its own) or 'full' (all);
        or a mapping from 'stdout', 'stderr' and 'both' to one or several of 'screen', 'log' and 'own_log'.

    Raises
    ------
    ValueError
        If it is not one of these.
    """
    destinations = _read_output_config(output_config)
    return (
        _output_logger(process_name, "stdout", destinations),
        _output_logger(process_name, "stderr", destinations),
    )


def reset() -> None:
    """Reset all loggers' handlers and levels to the default configuration."""
    for logger in (*LaunchLogger.all_loggers, logging.root):
        for handler in list(logger.handlers):
            ours = handler is launch_config._screen_handler or handler in launch_config._file_handlers.values()
            if ours or isinstance(logger, LaunchLogger):
                logger.removeHandler(handler)
        logger.setLevel(logging.NOTSET)
    for handler in launch_config._file_handlers.values():
        handler.close()
    launch_config.reset()


def _launch_logger(name: str | None) -> logging.Logger:
    if name is None:
        return logging.root
    manager = logging.root.manager
    previous_class = manager.loggerClass
    manager.loggerClass = LaunchLogger
    try:
        return logging.getLogger(name)
    finally:
        manager.loggerClass = previous_class


def _add_handler(logger: logging.Logger, handler: Any, formatter: logging.Formatter | None = None) -> None:
    if handler not in logger.handlers:
        if formatter is not None:
            handler.setFormatterFor(logger, formatter)
        logger.addHandler(handler)


def _read_output_config(output_config: str | Mapping[str, str | set[str]]) -> dict[str, set[str]]:
    if isinstance(output_config, str):
        if output_config not in _STANDARD_OUTPUTS:
            standard = ", ".join(f"'{name}'" for name in _STANDARD_OUTPUTS)
            raise ValueError(f"'{output_config}' is not a valid output configuration; these are: {standard}")
        output_config = _STANDARD_OUTPUTS[output_config]
    elif not isinstance(output_config, Mapping):
        raise ValueError(f"{output_config!r} is not a valid output configuration: neither a name nor a mapping")
    read: dict[str, set[str]] = {}
    for source in _SOURCES:
        value = output_config.get(source, set())
        read[source] = {value} if isinstance(value, str) else set(value)
    unknown = (set(output_config) - set(_SOURCES)) | (set().union(*read.values()) - _DESTINATIONS)
    if unknown:
        raise ValueError(f"{output_config!r} is not a valid output configuration: {', '.join(sorted(unknown))}")
    return read


def _output_logger(process_name: str, source: str, destinations: dict[str, set[str]]) -> logging.Logger:
    logger = _launch_logger(f"{process_name}-{source}")
    # What a process prints is passed on whatever launch's own verbosity is.
    logger.setLevel(logging.INFO)
    wanted = destinations["both"] | destinations[source]
    if "screen" in wanted:
        _add_handler(logger, launch_config.get_screen_handler(), output_screen_formatter())
    if "log" in wanted:
        _add_handler(
            logger,
            launch_config.get_log_file_handler(),
            logging.Formatter("{created:.7f} {message}", style="{"),
        )
    if "own_log" in destinations[source]:
        own = launch_config.get_log_file_handler(f"{process_name}-{source}.log")
        _add_handler(logger, own, logging.Formatter())
    if "own_log" in destinations["both"]:
        _add_handler(logger, launch_config.get_log_file_handler(f"{process_name}.log"), logging.Formatter())
    return logger
