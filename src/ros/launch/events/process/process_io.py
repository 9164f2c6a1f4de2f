"""The base of the events of what goes into and comes out of a process."""

from __future__ import annotations

from typing import Any

from .running_process_event import RunningProcessEvent


class ProcessIO(RunningProcessEvent):
    """A piece of input or output.

    Parameters
    ----------
    text
        The bytes.
    fd
        The stream: 0 for input, 1 for output, 2 for errors.
    **kwargs
        As for `RunningProcessEvent`.
    """

    name = "launch.events.process.ProcessIO"

    def __init__(self, *, text: bytes, fd: int, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__text = text
        self.__fd = fd

    @property
    def text(self) -> bytes:
        """The bytes."""
        return self.__text

    @property
    def from_stdin(self) -> bool:
        """Whether it goes to the standard input."""
        return self.__fd == 0

    @property
    def from_stdout(self) -> bool:
        """Whether it came from the standard output."""
        return self.__fd == 1

    @property
    def from_stderr(self) -> bool:
        """Whether it came from the standard error."""
        return self.__fd == 2
