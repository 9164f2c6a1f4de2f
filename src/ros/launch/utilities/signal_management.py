"""Signals delivered to an asyncio event loop."""

from __future__ import annotations

import asyncio
import signal
import socket
import sys
import threading
from collections.abc import Callable
from types import FrameType
from typing import Any, ClassVar

_AT_ONCE = 4096


class AsyncSafeSignalManager:
    """A context in which signals call functions inside an event loop.

    Handlers may be set before, after and while the context is entered; they are only active inside of it.
    Contexts nest: a signal reaches the handlers of the inner context first and then those of the outer one.
    On leaving, the handlers that were installed before come back. Must be entered in the main thread, as
    Python demands.

    Parameters
    ----------
    loop
        The event loop that runs the handlers.
    """

    __current: ClassVar[AsyncSafeSignalManager | None] = None

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self.__loop = loop
        self.__handlers: dict[int, Callable[[int], None]] = {}
        self.__replaced: dict[int, Any] = {}
        self.__parent: AsyncSafeSignalManager | None = None
        self.__active = False
        self.__waker: tuple[socket.socket, socket.socket] | None = None
        self.__told_before = -1

    def __enter__(self) -> AsyncSafeSignalManager:
        if self.__active:
            raise RuntimeError("the signal manager is already active")
        if threading.current_thread() is not threading.main_thread():
            raise RuntimeError("signals can only be handled in the main thread")
        self.__parent = AsyncSafeSignalManager.__current
        AsyncSafeSignalManager.__current = self
        self.__active = True
        self.__wake_with_signals()
        for signum in self.__handlers:
            self.__install(signum)
        return self

    def __exit__(self, *exception: object) -> None:
        for signum in list(self.__replaced):
            self.__uninstall(signum)
        self.__wake_no_more()
        self.__active = False
        AsyncSafeSignalManager.__current = self.__parent
        self.__parent = None

    def __wake_with_signals(self) -> None:
        """Wake the loop with every signal: one that comes just before the loop begins to wait would not."""
        if sys.platform == "win32":
            return  # the loop sees to it by itself there
        reader, writer = self.__waker = socket.socketpair()
        for end in self.__waker:
            end.setblocking(False)
        self.__loop.add_reader(reader, reader.recv, _AT_ONCE)
        self.__told_before = signal.set_wakeup_fd(writer.fileno(), warn_on_full_buffer=False)

    def __wake_no_more(self) -> None:
        if self.__waker is None:
            return
        try:
            signal.set_wakeup_fd(self.__told_before)
        except (OSError, ValueError):  # the receiver before has gone meanwhile
            signal.set_wakeup_fd(-1)
        reader, writer = self.__waker
        self.__waker = None
        if not self.__loop.is_closed():
            self.__loop.remove_reader(reader)
        reader.close()
        writer.close()

    def handle(
        self, signum: signal.Signals | int, handler: Callable[[int], None] | None
    ) -> Callable[[int], None] | None:
        """Set the handler of a signal, or remove it with None, and return the one it had.

        Parameters
        ----------
        signum
            The signal.
        handler
            Called inside the event loop with the signal's number.
        """
        signum = signal.Signals(signum)
        previous = self.__handlers.pop(signum, None)
        if handler is not None:
            self.__handlers[signum] = handler
        if self.__active and handler is not None and previous is None:
            self.__install(signum)
        elif self.__active and handler is None and previous is not None:
            self.__uninstall(signum)
        return previous

    def __install(self, signum: int) -> None:
        self.__replaced[signum] = signal.signal(signum, self.__on_signal)

    def __uninstall(self, signum: int) -> None:
        previous = self.__replaced.pop(signum)
        # None stands for a handler that was not installed from Python; it cannot be put back.
        signal.signal(signum, signal.SIG_DFL if previous is None else previous)

    def __on_signal(self, signum: int, frame: FrameType | None) -> None:
        # Python runs this between two instructions of the main thread, so it only hands over to the loops.
        manager: AsyncSafeSignalManager | None = self
        while manager is not None:
            handler = manager.__handlers.get(signum)
            if handler is not None and not manager.__loop.is_closed():
                manager.__loop.call_soon_threadsafe(handler, signal.Signals(signum))
            manager = manager.__parent
