"""The error of a launch file that cannot be read."""

from __future__ import annotations

from collections.abc import Sequence


class InvalidLaunchFileError(Exception):
    """A launch file could not be turned into a launch description.

    Parameters
    ----------
    extension
        The file's extension, which says what was tried.
    likely_errors
        What each reader that was tried had to say.
    """

    def __init__(self, extension: str = "", *, likely_errors: Sequence[Exception] | None = None) -> None:
        super().__init__(extension)
        self._extension = extension
        self._likely_errors = list(likely_errors or [])

    def __str__(self) -> str:
        if not self._likely_errors:
            return f"The launch file may have a syntax error, or its format [{self._extension}] is unknown"
        described = [f"{type(error).__name__}: {error}" for error in self._likely_errors]
        if len(described) == 1:
            return f"Caught exception when trying to load file of format [{self._extension}]: {described[0]}"
        listed = "".join(f"\n - {text}" for text in described)
        return f"Caught multiple exceptions when trying to load file of format [{self._extension}]:{listed}"
