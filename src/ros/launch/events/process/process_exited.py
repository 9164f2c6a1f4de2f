"""The event of a process that ended."""

from __future__ import annotations

from typing import Any

from .running_process_event import RunningProcessEvent


class ProcessExited(RunningProcessEvent):
    """A process ended.

    Parameters
    ----------
    returncode
        Its exit code, or minus the number of the signal that ended it.
    **kwargs
        As for `RunningProcessEvent`.
    """

    name = "launch.events.process.ProcessExited"

    def __init__(self, *, returncode: int, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__returncode = returncode

    @property
    def returncode(self) -> int:
        """The exit code, or minus the number of the signal that ended the process."""
        return self.__returncode
