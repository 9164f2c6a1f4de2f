"""A status that is easy to fill in."""

from __future__ import annotations

from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue


class DiagnosticStatusWrapper(DiagnosticStatus):
    """A ``diagnostic_msgs/msg/DiagnosticStatus`` with methods that fill it in.

    Levels may be given as the constants of the message or as numbers.
    """

    def __init__(self, *args: Any, **kwds: Any) -> None:
        fields = dict(zip(self.get_fields_and_field_types(), args, strict=False)) | kwds
        super().__init__(**{name: value for name, value in fields.items() if value is not None})

    def summary(self, *args: Any) -> None:
        """Set level and message: ``summary(level, message)``, or ``summary(status)`` to take another's."""
        level, message = _summary_of(args)
        self.level = level
        self.message = message

    def clearSummary(self) -> None:
        """Set the level to OK and the message to nothing."""
        self.summary(DiagnosticStatus.OK, "")

    def mergeSummary(self, *args: Any) -> None:
        """Merge another level and message into these; arguments as those of `summary`.

        The higher level counts. The messages of two that are both OK, or both not, are joined; otherwise the one of
        that which is OK is dropped.
        """
        level, message = _summary_of(args)
        if (level > DiagnosticStatus.OK) == (self.level > DiagnosticStatus.OK):
            self.message = f"{self.message}; {message}" if self.message else message
        elif level > self.level:
            self.message = message
        self.level = max(level, self.level)

    def add(self, key: str, val: Any) -> None:
        """Add a value under a key."""
        self.values.append(KeyValue(key=key, value=val if isinstance(val, str) else str(val)))


def _summary_of(arguments: tuple[Any, ...]) -> tuple[bytes, str]:
    if len(arguments) == 1:
        return arguments[0].level, arguments[0].message
    level, message = arguments
    return bytes([level]) if isinstance(level, int) else level, str(message)
