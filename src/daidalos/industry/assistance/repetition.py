"""Thread that sends the same again and again, until something else is set."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable
from typing import Generic, TypeVar

from daidalos.industry.assistance.device import DeviceError

T = TypeVar("T")


class Repetition(Generic[T]):
    """Sender of the newest value, at once and then after each period, until `close`.

    Parameters
    ----------
    name : str
        Of the thread.
    send : callable
        Sends a value; called by one thread at a time. May raise an `OSError`.
    value : object
        What is sent first.
    period : float
        Time between two repetitions [s].
    """

    def __init__(self, name: str, send: Callable[[T], None], value: T, period: float) -> None:
        self._send, self._value, self._period = send, value, period
        self._condition = threading.Condition()
        self._is_ending = False
        self._thread = threading.Thread(target=self._repeat, name=name, daemon=True)
        self._thread.start()

    def set(self, value: T) -> None:
        """Send a value now, and repeat it from now on.

        Raises
        ------
        DeviceError
            When it cannot be sent now; it is tried again.
        """
        with self._condition:
            self._value = value
            try:
                self._send(value)
            except OSError as error:
                raise DeviceError(f"cannot send: {error}") from None

    def close(self) -> None:
        """End the repetition."""
        with self._condition:
            self._is_ending = True
            self._condition.notify()
        self._thread.join()

    def _repeat(self) -> None:
        with self._condition:
            while not self._condition.wait_for(lambda: self._is_ending, self._period):
                with contextlib.suppress(OSError):  # the next one may arrive
                    self._send(self._value)
