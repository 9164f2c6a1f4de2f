"""Messages and reports of the doctor as text."""

from __future__ import annotations

import warnings
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ros2doctor.api import Report


def format_print(report: Report) -> None:
    """Print a report."""
    padding = compute_padding(report.items)
    lines = [f"\n   {report.name}", *(f"{name:{padding}}: {value}" for name, value in report.items)]
    print("\n".join(lines))  # noqa: T201


def compute_padding(report_items: Iterable[tuple[str, Any]]) -> int:
    """Return the width of the column of names: that of the longest and four more."""
    return max((len(name) for name, _ in report_items), default=0) + 4


def custom_warning_format(
    msg: Warning | str, cat: type[Warning], filename: str, linenum: int, file: Any = None, line: Any = None
) -> str:
    """Return a warning as one line of text, without the line of code."""
    return f"{filename}: {linenum}: {cat.__name__}: {msg}\n"


class CustomWarningFormat:
    """Context in which warnings are printed as `custom_warning_format` writes them."""

    def __enter__(self) -> None:
        self._before = warnings.formatwarning
        warnings.formatwarning = custom_warning_format  # type: ignore[assignment]

    def __exit__(self, *error: object) -> None:
        warnings.formatwarning = self._before


def doctor_warn(msg: str) -> None:
    """Print a warning of a check."""
    with CustomWarningFormat():
        warnings.warn(msg, stacklevel=2)


def doctor_error(msg: str) -> None:
    """Print an error of a check."""
    with CustomWarningFormat():
        warnings.warn(f"ERROR: {msg}", stacklevel=2)
