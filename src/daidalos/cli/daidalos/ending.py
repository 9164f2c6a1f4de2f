"""Wait for Ctrl-C or the signal by which a service manager ends a program."""

from __future__ import annotations

import select
import signal
import socket
from types import FrameType


class Ending:
    """Context in which Ctrl-C and SIGTERM end `wait` instead of the program at once."""

    def __init__(self) -> None:
        self._before: list[tuple[int, object]] = []

    def __enter__(self) -> Ending:
        # A handler may run while `wait` holds the lock of an event, so that it must take none: a byte in a socket does.
        self._reader, self._writer = socket.socketpair()
        self._writer.setblocking(False)
        for number in (signal.SIGINT, signal.SIGTERM):
            self._before.append((number, signal.signal(number, self._end)))
        return self

    def __exit__(self, *error: object) -> None:
        for number, handler in self._before:
            signal.signal(number, handler)  # type: ignore[arg-type]
        self._reader.close()
        self._writer.close()

    def wait(self, seconds: float | None = None) -> bool:
        """Wait for the end, at most some time; return whether it has come."""
        ready, _, _ = select.select([self._reader], [], [], seconds)
        return bool(ready)

    def _end(self, number: int, frame: FrameType | None) -> None:
        try:
            self._writer.send(b"\0")
        except BlockingIOError:  # there are many already
            return
