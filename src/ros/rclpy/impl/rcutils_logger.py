"""Loggers, with filters by call site: once, skip_first and throttle."""

from __future__ import annotations

import inspect
import os
import sys
import time
import weakref
from collections import namedtuple
from types import CodeType, FrameType
from typing import Any, ClassVar

from rclpy.clock_type import ClockType
from rclpy.impl.log_output import OUTPUT, Record
from rclpy.impl.logging_severity import LoggingSeverity

_internal_callers: list[str] = []
_HERE = os.path.normcase(__file__)


class CallerId(namedtuple("CallerId", ["function_name", "file_path", "line_number", "last_index"])):
    """The place that a log call is made from."""

    __slots__ = ()

    def __new__(cls, frame: FrameType | None = None) -> CallerId:
        """Describe `frame`, by default the first one outside of this module."""
        frame = frame or _find_caller(inspect.currentframe())
        code = frame.f_code
        return super().__new__(cls, code.co_name, os.path.abspath(code.co_filename), frame.f_lineno, frame.f_lasti)


def _find_caller(frame: FrameType | None) -> FrameType:
    """Return the first frame that belongs to neither this module nor one that wraps it."""
    while frame is not None:
        if os.path.normcase(frame.f_code.co_filename) != _HERE:
            return frame
        frame = frame.f_back
    raise RuntimeError("no caller")


class LoggingFilter:
    """Filter that decides whether a log call is carried out.

    `params` are the keyword arguments that it takes with their defaults; one whose default is None is needed.
    """

    params: ClassVar[dict[str, Any]] = {}

    @classmethod
    def initialize_context(cls, context: dict[str, Any], **kwargs: Any) -> None:
        """Store the filter's arguments of a call site's first call."""
        for param, default in cls.params.items():
            context[param] = kwargs.get(param, default)
            if context[param] is None:
                raise TypeError(f"Required parameter '{param}' was not specified for logging filter '{cls.__name__}'")

    @staticmethod
    def should_log(context: dict[str, Any]) -> bool:
        """Return whether this call is carried out, and note that it was made."""
        raise NotImplementedError


class Once(LoggingFilter):
    """Only the first call."""

    params: ClassVar[dict[str, Any]] = {"once": None}

    @classmethod
    def initialize_context(cls, context: dict[str, Any], **kwargs: Any) -> None:
        """Start without a call."""
        super().initialize_context(context, **kwargs)
        context["has_been_logged_once"] = False

    @staticmethod
    def should_log(context: dict[str, Any]) -> bool:
        """Return whether this is the first call."""
        logged: bool = context["has_been_logged_once"]
        context["has_been_logged_once"] = True
        return not logged


class Throttle(LoggingFilter):
    """At most one call in `throttle_duration_sec` seconds of `throttle_time_source_type`."""

    params: ClassVar[dict[str, Any]] = {
        "throttle_duration_sec": None,
        "throttle_time_source_type": ClockType.STEADY_TIME,
    }

    @classmethod
    def initialize_context(cls, context: dict[str, Any], **kwargs: Any) -> None:
        """Start without a call."""
        super().initialize_context(context, **kwargs)
        source = context["throttle_time_source_type"]
        if not hasattr(source, "now") and not isinstance(source, ClockType):
            raise ValueError(
                f"Received throttle_time_source_type of '{source}' is not a clock instance and not a ClockType"
            )
        # By a clock, nothing is logged in the first period after time zero, as in ROS 2.
        context["throttle_last_logged"] = 0 if hasattr(source, "now") else None

    @staticmethod
    def should_log(context: dict[str, Any]) -> bool:
        """Return whether the last call carried out is long enough ago."""
        source = context["throttle_time_source_type"]
        if hasattr(source, "now"):
            now = source.now().nanoseconds
        elif source == ClockType.STEADY_TIME:
            now = time.monotonic_ns()
        else:
            now = time.time_ns()
        last = context["throttle_last_logged"]
        if last is not None and last <= now < last + context["throttle_duration_sec"] * 1e9:
            return False
        context["throttle_last_logged"] = now
        return True


class SkipFirst(LoggingFilter):
    """Filter that skips the first call."""

    params: ClassVar[dict[str, Any]] = {"skip_first": None}

    @classmethod
    def initialize_context(cls, context: dict[str, Any], **kwargs: Any) -> None:
        """Start without a call."""
        super().initialize_context(context, **kwargs)
        context["first_has_been_skipped"] = False

    @staticmethod
    def should_log(context: dict[str, Any]) -> bool:
        """Return whether there was a call before."""
        skipped: bool = context["first_has_been_skipped"]
        context["first_has_been_skipped"] = True
        return skipped


supported_filters: dict[str, type[LoggingFilter]] = {
    "throttle": Throttle,
    "skip_first": SkipFirst,
    "once": Once,
}


def get_filters_from_kwargs(**kwargs: Any) -> list[str]:
    """Return the names of the filters that keyword arguments ask for.

    Raises
    ------
    TypeError
        When an argument belongs to no filter, or a filter lacks one that it needs.
    """
    detected = []
    known: set[str] = set()
    for name, kind in supported_filters.items():
        known |= kind.params.keys()
        if any(kwargs.get(param) for param, default in kind.params.items() if default is None):
            detected.append(name)
    for name in kwargs:
        if name not in known:
            raise TypeError(f"parameter '{name}' is not one of the recognized logging options '{sorted(known)}'")
    for name, kind in supported_filters.items():
        needed = [param for param, default in kind.params.items() if default is None]
        given = [param for param in kind.params if param in kwargs]
        if given and any(param not in kwargs for param in needed):
            raise TypeError(f"required parameter '{needed[0]}' not specified but is required for the '{name}' filter")
    return detected


class RcutilsLogger:
    """A logger; names are hierarchical, ``parent.child``."""

    _UNSET = LoggingSeverity.UNSET

    def __init__(self, name: str = "", owner: Any = None) -> None:
        self.name = name
        self._owner = weakref.ref(owner) if owner is not None else None
        self.contexts: dict[CallerId, dict[str, Any]] = {}
        self._places: dict[tuple[CodeType, int], tuple[str, LoggingSeverity]] = {}

    def get_child(self, name: str) -> RcutilsLogger:
        """Return the logger below this one.

        Raises
        ------
        ValueError
            For an empty name.
        RuntimeError
            When this is the logger of a node that is no more: nothing would reach ``/rosout``.
        """
        if not name:
            raise ValueError("Child logger name must not be empty.")
        if self._owner is not None and self._owner() is None:
            raise RuntimeError("Logger is already invalid because node is destroyed.")
        if self.name:
            name = f"{self.name}.{name}"
        return RcutilsLogger(name=name)

    def set_level(self, level: int | LoggingSeverity) -> None:
        """Set the least severity that is logged; UNSET follows the ancestors."""
        OUTPUT.set_level(self.name, LoggingSeverity(level))

    def get_effective_level(self) -> LoggingSeverity:
        """Return the level that applies."""
        return OUTPUT.effective_level(self.name)

    def is_enabled_for(self, severity: int | LoggingSeverity) -> bool:
        """Return whether messages of this severity are logged."""
        return LoggingSeverity(severity) >= OUTPUT.effective_level(self.name)

    def log(self, message: str, severity: int | LoggingSeverity, **kwargs: Any) -> bool:
        """Log a message.

        Parameters
        ----------
        message
            What to say.
        severity
            How important it is.
        **kwargs
            ``once``, ``skip_first``, ``throttle_duration_sec``, ``throttle_time_source_type``; they apply to
            the place that the call is made from and must be the same at every call there. ``name`` logs under
            another name.

        Returns
        -------
        bool
            Whether the message was logged.

        Raises
        ------
        TypeError
            For an unknown argument, or a filter that lacks one.
        ValueError
            When severity or filters differ from those of an earlier call at the same place.
        """
        severity = LoggingSeverity(severity)
        name = kwargs.pop("name", self.name)
        if kwargs:
            caller = CallerId()
            if not self._passes(caller, severity, kwargs):
                return False
        if severity < OUTPUT.effective_level(name):
            return False
        frame = _find_caller(sys._getframe(1))
        code = frame.f_code
        if self._places.setdefault((code, frame.f_lasti), (name, severity)) != (name, severity):
            self._raise_changed(code, frame.f_lasti, name)
        file = OUTPUT.source_file(code.co_filename)
        OUTPUT.write(Record(severity, name, str(message), time.time_ns(), code.co_name, file, frame.f_lineno))
        return True

    def _raise_changed(self, code: CodeType, position: int, name: str) -> None:
        before, _ = self._places[code, position]
        what = "name" if before != name else "severity"
        raise ValueError(f"Logger {what} cannot be changed between calls.")

    def _passes(self, caller: CallerId, severity: LoggingSeverity, kwargs: dict[str, Any]) -> bool:
        context = self.contexts.get(caller)
        if context is None:
            detected = get_filters_from_kwargs(**kwargs)
            context = {"severity": severity, "filters": detected}
            for name in detected:
                supported_filters[name].initialize_context(context, **kwargs)
            context["arguments"] = dict(kwargs)
            self.contexts[caller] = context
        if context["severity"] != severity:
            raise ValueError("Logger severity cannot be changed between calls.")
        for key, value in kwargs.items():
            if context["arguments"].get(key, value) != value or (key not in context["arguments"] and value):
                raise ValueError("Logging filter parameters cannot be changed between calls.")
        if severity < OUTPUT.effective_level(self.name):
            return False
        return all(supported_filters[name].should_log(context) for name in context["filters"])

    def debug(self, message: str, **kwargs: Any) -> bool:
        """Log with severity DEBUG."""
        return self.log(message, LoggingSeverity.DEBUG, **kwargs)

    def info(self, message: str, **kwargs: Any) -> bool:
        """Log with severity INFO."""
        return self.log(message, LoggingSeverity.INFO, **kwargs)

    def warning(self, message: str, **kwargs: Any) -> bool:
        """Log with severity WARN."""
        return self.log(message, LoggingSeverity.WARN, **kwargs)

    def warn(self, message: str, **kwargs: Any) -> bool:
        """Log with severity WARN."""
        return self.warning(message, **kwargs)

    def error(self, message: str, **kwargs: Any) -> bool:
        """Log with severity ERROR."""
        return self.log(message, LoggingSeverity.ERROR, **kwargs)

    def fatal(self, message: str, **kwargs: Any) -> bool:
        """Log with severity FATAL."""
        return self.log(message, LoggingSeverity.FATAL, **kwargs)
