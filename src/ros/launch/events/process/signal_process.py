"""The event that sends a signal to processes."""

from __future__ import annotations

import signal
from collections.abc import Callable
from typing import TYPE_CHECKING

from .process_targeted_event import ProcessTargetedEvent

if TYPE_CHECKING:
    from ...actions.execute_local import ExecuteLocal


class SignalProcess(ProcessTargetedEvent):
    """Processes are to get a signal.

    Parameters
    ----------
    signal_number
        The signal or its name, such as 'SIGINT'.
    process_matcher
        Tells whether the process of an action is meant.
    """

    name = "launch.events.process.SignalProcess"

    def __init__(
        self, *, signal_number: str | signal.Signals | int, process_matcher: Callable[[ExecuteLocal], bool]
    ) -> None:
        super().__init__(process_matcher=process_matcher)
        if isinstance(signal_number, str):
            name = signal_number if signal_number.startswith("SIG") else f"SIG{signal_number}"
            if name not in signal.Signals.__members__:
                raise ValueError(f"'{signal_number}' is not the name of a signal")
            self.__signal = signal.Signals[name]
        else:
            self.__signal = signal.Signals(signal_number)

    @property
    def signal(self) -> signal.Signals:
        """The signal."""
        return self.__signal

    @property
    def signal_name(self) -> str:
        """The signal's name."""
        return self.__signal.name
