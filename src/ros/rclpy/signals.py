"""Ctrl-C and termination: the contexts are shut down, so that `spin` and all waiting calls return."""

from __future__ import annotations

import math
import signal
import sys
import threading
import time
import weakref
from enum import IntFlag
from types import FrameType, TracebackType
from typing import Any

from daidalos.common import tracebacks
from rclpy.context import Context
from rclpy.exceptions import ExternalShutdownException, ROSInterruptException
from rclpy.guard_condition import GuardCondition
from rclpy.impl import signal_watch
from rclpy.impl.interrupts import is_uninterrupted


class SignalHandlerOptions(IntFlag):
    """Selection of handled signals."""

    NO = 0
    SIGINT = 1
    SIGTERM = 2
    ALL = 3


_lock = threading.Lock()
_contexts: weakref.WeakSet[Context] = weakref.WeakSet()
_guards: weakref.WeakSet[GuardCondition] = weakref.WeakSet()
_installed = SignalHandlerOptions.NO
_previous: dict[int, Any] = {}
_previous_hook: Any = None
_NUMBERS = {SignalHandlerOptions.SIGINT: signal.SIGINT, SignalHandlerOptions.SIGTERM: signal.SIGTERM}


def install_signal_handlers(options: SignalHandlerOptions = SignalHandlerOptions.ALL) -> None:
    """Handle signals from now on; only the main thread can."""
    global _installed, _previous_hook
    if threading.current_thread() is not threading.main_thread():
        return
    with _lock:
        for option, number in _NUMBERS.items():
            if option in options and option not in _installed:
                _previous[number] = signal.signal(number, _on_signal)
        if _installed == SignalHandlerOptions.NO and options != SignalHandlerOptions.NO:
            _previous_hook, sys.excepthook = sys.excepthook, _quiet_excepthook
            threading.excepthook = _quiet_thread_excepthook
        _installed |= options
        if _installed != SignalHandlerOptions.NO:
            signal_watch.start()


def uninstall_signal_handlers() -> None:
    """Handle signals no more."""
    global _installed
    if threading.current_thread() is not threading.main_thread():
        return
    with _lock:
        for number, handler in _previous.items():
            if signal.getsignal(number) is _on_signal:
                signal.signal(number, handler if handler is not None else signal.SIG_DFL)
        _previous.clear()
        _installed = SignalHandlerOptions.NO
        signal_watch.stop()


def get_current_signal_handlers_options() -> SignalHandlerOptions:
    """Return which signals are handled."""
    return _installed


def watch_context(context: Context) -> None:
    """Shut a context down at a signal."""
    _contexts.add(context)


_REPEAT_INTERVAL_S = 0.5
_last_signal_s = -math.inf
_IMPORT_S = 1.0
"""Time after a signal in which an import that fails has failed because of it."""

_IMPORT_MACHINERY = "<frozen importlib._bootstrap>"
_DEFERRAL_S = 0.01
_deferred: set[int] = set()


@signal_watch.watched
def _on_signal(number: int, frame: FrameType | None) -> None:
    global _last_signal_s
    if number in _deferred:
        _deferred.discard(number)
        if not is_uninterrupted():
            _pass_on(number, frame)
        return
    now = time.monotonic()
    if is_uninterrupted() or now - _last_signal_s < _REPEAT_INTERVAL_S:
        return  # the terminal and the launcher pass on the same Ctrl-C
    _last_signal_s = now
    for context in list(_contexts):
        context.shutdown_by_signal()
    for guard in list(_guards):
        guard.trigger()
    _pass_on(number, frame)


def _pass_on(number: int, frame: FrameType | None) -> None:
    """Call the handler that was there before, which raises KeyboardInterrupt if it is Python's own.

    Not between two steps of Python's import system: it holds a lock then that it would not release any more, and
    every other thread that imports something would wait for ever.
    """
    if frame is not None and frame.f_code.co_filename == _IMPORT_MACHINERY and hasattr(signal, "pthread_kill"):
        _deferred.add(number)
        threading.Thread(target=_send_again, args=(number,), name="signal again", daemon=True).start()
        return
    previous = _previous.get(number)
    if number == signal.SIGINT and previous == signal.SIG_DFL:
        # Nobody had set a handler that stands in for Python's own, only kept it quiet while modules were imported.
        previous = signal.default_int_handler
    if callable(previous):
        previous(number, frame)


def _send_again(number: int) -> None:
    time.sleep(_DEFERRAL_S)
    main = threading.main_thread().ident
    if number in _deferred and main is not None:
        signal.pthread_kill(main, number)


def _quiet_excepthook(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
    """Suppress the traceback when a program ends because it was asked to."""
    if not is_orderly(error):
        (tracebacks.show if _previous_hook in (None, sys.__excepthook__) else _previous_hook)(kind, error, trace)


def _quiet_thread_excepthook(arguments: threading.ExceptHookArgs) -> None:
    """Suppress the traceback of a thread that spins."""
    if arguments.exc_value is None or not is_orderly(arguments.exc_value):
        threading.__excepthook__(arguments)


def is_orderly(error: BaseException) -> bool:
    """Return whether an exception only ends the program.

    An interrupt while a compiled module is being imported arrives as the cause of an ImportError, or is lost in one.
    """
    if isinstance(error, (KeyboardInterrupt, ExternalShutdownException, ROSInterruptException)):
        return True
    if not isinstance(error, ImportError):
        return False
    return time.monotonic() - _last_signal_s < _IMPORT_S or (
        error.__cause__ is not None and is_orderly(error.__cause__)
    )


class SignalHandlerGuardCondition(GuardCondition):
    """A guard condition that a signal triggers."""

    def __init__(self, context: Context | None = None) -> None:
        super().__init__(callback=None, callback_group=None, context=context)
        _guards.add(self)

    def destroy(self) -> None:
        """Destroy the guard condition."""
        _guards.discard(self)
        super().destroy()
