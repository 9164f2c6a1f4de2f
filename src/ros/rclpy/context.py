"""Contexts: the life of rclpy between `init` and `shutdown`."""

from __future__ import annotations

import sys
import threading
import weakref
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager

from rclpy.exceptions import NotInitializedException
from rclpy.impl.context import ContextHandle
from rclpy.impl.log_output import OUTPUT

g_logging_configure_lock = threading.Lock()
g_logging_ref_count = 0


class Context(AbstractContextManager["Context"]):
    """Scope of one `init` and `shutdown`; usable as ``with Context() as context:`` too."""

    def __init__(self) -> None:
        self._lock = threading.RLock()
        self._callbacks: list[weakref.ref[Callable[[], None]]] = []
        self._logging_initialized = False
        self._ended_by_signal = False
        self.__handle: ContextHandle | None = None

    @property
    def handle(self) -> ContextHandle | None:
        """What is behind the context, None before `init`."""
        return self.__handle

    def destroy(self) -> None:
        """Shut down and leave the graph."""
        with self._lock:
            handle, self.__handle = self.__handle, None
        if handle:
            handle.destroy_when_not_in_use()

    def init(
        self,
        args: Sequence[str] | None = None,
        *,
        initialize_logging: bool = True,
        domain_id: int | None = None,
    ) -> None:
        """Initialize the context from command-line arguments.

        Parameters
        ----------
        args
            Command-line arguments; those of the process where None.
        initialize_logging
            Whether log levels in the arguments take effect.
        domain_id
            The domain; ``ROS_DOMAIN_ID`` where None.

        Raises
        ------
        RuntimeError
            When it was begun before, for a negative domain and for arguments that cannot be understood.
        """
        with self._lock:
            if domain_id is not None and domain_id < 0:
                raise RuntimeError(f"Domain id ({domain_id}) should not be lower than zero.")
            if self.__handle is not None:
                if self.__handle.ok():
                    raise RuntimeError("Context.init() must only be called once")
                self.destroy()
            arguments = list(sys.argv if args is None else args)
            for argument in arguments:
                argument.encode()  # UnicodeEncodeError for what is not valid text
            try:
                self.__handle = ContextHandle(arguments, domain_id)
            except ValueError as error:
                raise RuntimeError(str(error)) from None
            self.__handle.on_shutdown(self._call_on_shutdown_callbacks)
            self._ended_by_signal = False
            if initialize_logging:
                self._initialize_logging(self.__handle)

    def _initialize_logging(self, handle: ContextHandle) -> None:
        global g_logging_ref_count
        with g_logging_configure_lock:
            g_logging_ref_count += 1
            self._logging_initialized = True
            if g_logging_ref_count > 1:
                return
            arguments = handle.arguments
            OUTPUT.to_console = arguments.stdout_logs
            OUTPUT.to_file = arguments.external_lib_logs
            OUTPUT.file_stem = arguments.log_file_name
            for name, level in arguments.log_levels.items():
                OUTPUT.set_level(name, level)  # type: ignore[arg-type]

    def _finalize_logging(self) -> None:
        global g_logging_ref_count
        with g_logging_configure_lock:
            if not self._logging_initialized:
                return
            self._logging_initialized = False
            g_logging_ref_count -= 1
            if g_logging_ref_count == 0:
                OUTPUT.close()

    def ok(self) -> bool:
        """Return whether the context is between `init` and `shutdown`."""
        handle = self.__handle
        return handle is not None and handle.ok()

    def _call_on_shutdown_callbacks(self) -> None:
        with self._lock:
            callbacks, self._callbacks = self._callbacks, []
        for reference in callbacks:
            callback = reference()
            if callback is not None:
                callback()

    def shutdown(self) -> None:
        """Shut down the context and leave the graph.

        Raises
        ------
        RuntimeError
            When the context is not initialized. After a shutdown by Ctrl-C, one call is allowed: programs make it.
        """
        handle = self._initialised_handle("shut down")
        if not handle.try_shutdown() and not self._ended_by_signal:
            handle.shutdown()
        self._ended_by_signal = False
        handle.release()
        self._finalize_logging()

    def try_shutdown(self) -> None:
        """Shut down the context unless that was done before."""
        handle = self.__handle
        if handle is not None:
            handle.try_shutdown()
            handle.release()
            self._finalize_logging()

    def shutdown_by_signal(self) -> None:
        """Shut down the context after a signal; the graph is left later, outside the signal's handler."""
        handle = self.__handle
        if handle is not None and handle.try_shutdown():
            self._ended_by_signal = True

    @property
    def ended_by_signal(self) -> bool:
        """Whether a signal ended it, and nothing has since."""
        return self._ended_by_signal

    def _initialised_handle(self, action: str) -> ContextHandle:
        if self.__handle is None:
            raise RuntimeError(f"Context must be initialized before it can be {action}")
        return self.__handle

    def on_shutdown(self, callback: Callable[[], None]) -> None:
        """Call `callback` at the end; it is not kept alive by that.

        Raises
        ------
        TypeError
            When it cannot be called.
        """
        if not callable(callback):
            raise TypeError("callback should be a callable")
        if hasattr(callback, "__self__"):
            reference: weakref.ref[Callable[[], None]] = weakref.WeakMethod(callback)
        else:
            reference = weakref.ref(callback)
        with self._lock:
            if not self.ok():
                callback()
            else:
                self._callbacks = [other for other in self._callbacks if other() is not None]
                self._callbacks.append(reference)

    def get_domain_id(self) -> int:
        """Return the domain.

        Raises
        ------
        RuntimeError
            Before `init`.
        """
        if self.__handle is None:
            raise RuntimeError("Context must be initialized before it can have a domain id")
        return self.__handle.get_domain_id()

    def __enter__(self) -> Context:
        if self.__handle is None:
            self.init()
        return self

    def __exit__(self, *exception: object) -> None:
        self.try_shutdown()


def initialized(context: Context | None) -> Context:
    """Return the context, or the default one where None.

    Raises
    ------
    NotInitializedException
        When it is not begun.
    """
    from rclpy.utilities import get_default_context

    context = context or get_default_context()
    if not context.ok():
        raise NotInitializedException()
    return context
