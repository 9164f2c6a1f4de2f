"""Location of errors in launch files: `file:line: reason` for any exception raised while launching."""

from __future__ import annotations

import os
import sys
from types import FrameType

from .invalid_launch_file_error import InvalidLaunchFileError

_LOCATION_ATTRIBUTE = "__launch_location__"

# Python launch files that have been loaded, as their code objects name them.
_loaded_launch_files: set[str] = set()


class LaunchFileError(InvalidLaunchFileError):
    """A mistake in a launch file, ready to be shown to the person who wrote it.

    Parameters
    ----------
    file
        The launch file, or None where the mistake was made in a script.
    line
        Line in that file, counted from 1, or None where it is not known.
    reason
        What is wrong, in one line.
    """

    def __init__(self, file: str | None, line: int | None, reason: str) -> None:
        super().__init__(os.path.splitext(file or "")[1].lstrip("."))
        self.file = file
        self.line = line
        self.reason = reason

    def __str__(self) -> str:
        if self.file is None:
            return self.reason if self.line is None else f"line {self.line}: {self.reason}"
        return f"{self.file}: {self.reason}" if self.line is None else f"{self.file}:{self.line}: {self.reason}"

    @classmethod
    def from_exception(cls, error: BaseException, file: str | None = None) -> LaunchFileError:
        """Describe where `error` came from; `file` is the launch file to name when nothing better is known."""
        if isinstance(error, LaunchFileError):
            return error
        likely = getattr(error, "_likely_errors", [])
        if len(likely) == 1:
            return cls.from_exception(likely[0], file)
        if isinstance(error, SyntaxError) and error.filename and not error.filename.startswith("<"):
            return cls(error.filename, error.lineno, f"{type(error).__name__}: {error.msg}")
        location = getattr(error, _LOCATION_ATTRIBUTE, None)
        frame = _innermost_launch_frame(error)
        known_file, line = location or frame
        return cls(known_file or file, line, _reason(error, in_python=location is None and frame[0] is not None))


def add_location(error: BaseException, file: str | None, line: int | None) -> None:
    """Attach to an exception where in a launch file it happened, unless something closer to it already did."""
    known = hasattr(error, _LOCATION_ATTRIBUTE) or _innermost_launch_frame(error)[0] is not None
    if not known and (file is not None or line is not None):
        setattr(error, _LOCATION_ATTRIBUTE, (file, line))


def register_launch_file(file: str) -> None:
    """Register a Python launch file, so that its lines can be distinguished from those of libraries."""
    _loaded_launch_files.add(file)


def calling_launch_file() -> tuple[str | None, int | None]:
    """Return the file and line of the innermost caller that is a Python launch file."""
    if _loaded_launch_files:
        frame: FrameType | None = sys._getframe(1)
        while frame is not None:
            if frame.f_code.co_filename in _loaded_launch_files:
                return frame.f_code.co_filename, frame.f_lineno
            frame = frame.f_back
    return None, None


def _innermost_launch_frame(error: BaseException) -> tuple[str | None, int | None]:
    found: tuple[str | None, int | None] = (None, None)
    step = error.__traceback__
    while step is not None:
        if step.tb_frame.f_code.co_filename in _loaded_launch_files:
            found = step.tb_frame.f_code.co_filename, step.tb_lineno
        step = step.tb_next
    return found


def _reason(error: BaseException, *, in_python: bool) -> str:
    kind = type(error).__name__
    missing_key = isinstance(error, KeyError)
    text = " ".join(str(error.args[0] if missing_key and error.args else error).split())
    # Launch's own errors explain themselves; those of a user's Python code, and keys, need the kind of error.
    if type(error) is KeyError or (in_python and not isinstance(error, RuntimeError | InvalidLaunchFileError)):
        text = f"{kind}: {text}"
    notes = "".join(f" ({note})" for note in getattr(error, "__notes__", []))
    return (text or kind) + notes
