"""The event of output from the standard output of a process."""

from __future__ import annotations

from typing import Any

from .process_io import ProcessIO


class ProcessStdout(ProcessIO):
    """A piece of output from the standard output of a process.

    Parameters
    ----------
    text
        The bytes.
    **kwargs
        As for `RunningProcessEvent`.
    """

    name = "launch.events.process.ProcessStdout"

    def __init__(self, *, text: bytes, **kwargs: Any) -> None:
        super().__init__(text=text, fd=1, **kwargs)
