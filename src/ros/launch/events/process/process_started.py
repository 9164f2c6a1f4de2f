"""The event of a process that was started."""

from __future__ import annotations

from typing import Any

from .running_process_event import RunningProcessEvent


class ProcessStarted(RunningProcessEvent):
    """A process was started; parameters as for `RunningProcessEvent`."""

    name = "launch.events.process.ProcessStarted"

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
