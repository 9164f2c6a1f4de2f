"""Futures, and tasks that an executor carries out."""

from __future__ import annotations

import inspect
import sys
import threading
import warnings
import weakref
from collections.abc import Callable, Coroutine, Generator
from types import GenericAlias
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

if TYPE_CHECKING:
    import asyncio

_stepping = threading.local()  # whether an executor runs a coroutine in this thread


def _asyncio_loop() -> asyncio.AbstractEventLoop | None:
    """Return the loop that runs in this thread; asyncio is not imported for that, as it takes a while."""
    asyncio = sys.modules.get("asyncio")
    return asyncio._get_running_loop() if asyncio is not None else None


def _write_warning(error: BaseException) -> None:
    print(f"The following exception was never retrieved: {error}", file=sys.stderr)  # noqa: T201


def _no_executor() -> None:
    """Return None, in place of a reference to an executor."""


class TaskRunner(Protocol):
    """Contract of executors for futures."""

    def create_task(self, callback: Callable[..., Any] | Coroutine[Any, Any, Any], *args: Any, **kwargs: Any) -> Task:
        """Schedule a function or coroutine, and return it as a task."""


class Future:
    """The result of something that is not yet done; a coroutine may ``await`` it."""

    __class_getitem__: ClassVar[Any] = classmethod(GenericAlias)

    def __init__(self, *, executor: TaskRunner | None = None) -> None:
        self._done = False
        self._cancelled = False
        self._result: Any = None
        self._exception: BaseException | None = None
        self._exception_fetched = False
        self._callbacks: list[Callable[[Future], None]] = []
        self._lock = threading.Lock()
        self._executor: Callable[[], TaskRunner | None] = _no_executor
        if executor is not None:
            self._set_executor(executor)

    def __del__(self) -> None:
        if getattr(self, "_exception", None) is not None and not self._exception_fetched:
            _write_warning(self._exception)  # type: ignore[arg-type]

    def __await__(self) -> Generator[Any, None, Any]:
        while not self._pending_over():
            loop = None if getattr(_stepping, "count", 0) else _asyncio_loop()
            if loop is None:
                yield self
            else:
                yield from self._in(loop)
        return self.result()

    def _in(self, loop: asyncio.AbstractEventLoop) -> Generator[Any, None, None]:
        """Wait as a coroutine that asyncio runs; somebody else, of this thread or another, has to spin."""
        over = loop.create_future()

        def release() -> None:
            if not over.done():
                over.set_result(None)

        def wake() -> None:
            if not loop.is_closed():
                loop.call_soon_threadsafe(release)

        self.on_wake(wake)
        yield from over

    def _pending_over(self) -> bool:
        return self._done or self._cancelled

    def cancel(self) -> None:
        """Cancel the future; without effect when it is done."""
        with self._lock:
            if self._done:
                return
            self._cancelled = True
        self._schedule_or_invoke_done_callbacks()

    def cancelled(self) -> bool:
        """Return whether it was given up."""
        return self._cancelled

    def done(self) -> bool:
        """Return whether there is a result or an exception."""
        return self._done

    def result(self) -> Any:
        """Return the result, None when there is none yet; raise the exception that came instead."""
        if self._exception is not None:
            self._exception_fetched = True
            raise self._exception
        return self._result

    def exception(self) -> BaseException | None:
        """Return the exception that came instead of a result, if one did."""
        self._exception_fetched = True
        return self._exception

    def set_result(self, result: Any) -> None:
        """Complete the future with a result."""
        with self._lock:
            self._result = result
            self._done = True
            self._cancelled = False
        self._schedule_or_invoke_done_callbacks()

    def set_exception(self, exception: BaseException) -> None:
        """Complete the future with an exception."""
        with self._lock:
            self._exception = exception
            self._exception_fetched = False
            self._done = True
            self._cancelled = False
        self._schedule_or_invoke_done_callbacks()

    def _schedule_or_invoke_done_callbacks(self) -> None:
        """Call what waits for the end: through the executor if there is one, else here."""
        with self._lock:
            callbacks, self._callbacks = self._callbacks, []
        executor = self._executor()
        for callback in callbacks:
            if executor is not None and not isinstance(callback, _Wake):
                executor.create_task(callback, self)
            else:
                _call(callback, self)

    def _set_executor(self, executor: TaskRunner | None) -> None:
        """Set the executor that calls the callbacks."""
        self._executor = _no_executor if executor is None else weakref.ref(executor)

    def add_done_callback(self, callback: Callable[[Future], None]) -> None:
        """Call ``callback(future)`` when it is done; at once if it is."""
        with self._lock:
            if not self._pending_over():
                self._callbacks.append(callback)
                return
        executor = self._executor()
        if executor is not None:
            executor.create_task(callback, self)
        else:
            _call(callback, self)

    def remove_done_callback(self, callback: Callable[[Future], None]) -> bool:
        """Remove a callback; return whether it was waiting."""
        with self._lock:
            before = len(self._callbacks)
            self._callbacks = [other for other in self._callbacks if other != callback]
            return len(self._callbacks) < before

    def on_wake(self, wake: Callable[[], None]) -> None:
        """Call `wake` when it is over: at once, and not through an executor."""
        with self._lock:
            if not self._pending_over():
                self._callbacks.insert(0, _Wake(wake))
                return
        wake()


class _Wake:
    """A callback that only wakes a waiter, and so needs no executor."""

    def __init__(self, wake: Callable[[], None]) -> None:
        self.wake = wake

    def __call__(self, future: Future) -> None:
        self.wake()


def _call(callback: Callable[[Future], Any], future: Future) -> None:
    # A broken callback must not keep the others from being called.
    try:
        callback(future)
    except Exception as error:
        warnings.warn(f"Unhandled exception in done callback: {error}", RuntimeWarning, stacklevel=2)


_NOTHING = object()
"""What a coroutine waits for that yields None."""


class Task(Future):
    """A function or a coroutine that an executor carries out; it is the future of its own result.

    Parameters
    ----------
    handler
        A function, a coroutine function or a coroutine.
    args, kwargs
        Its arguments.
    executor
        Who carries it out.
    """

    def __init__(
        self,
        handler: Any,
        args: Any = None,
        kwargs: Any = None,
        executor: TaskRunner | None = None,
    ) -> None:
        super().__init__(executor=executor)
        self._args = list(args or ())
        self._kwargs = dict(kwargs or {})
        self._handler = handler
        if inspect.iscoroutinefunction(handler):
            self._handler = handler(*self._args, **self._kwargs)
            self._args, self._kwargs = [], {}
        self._executing = False
        self._task_lock = threading.Lock()
        self._requeue: Callable[[Task], None] | None = None
        self._entity: Any = None  # whose callback group the task holds

    def __call__(self) -> None:
        """Run until it is done, or until it waits for something."""
        if self._done or self._executing or not self._task_lock.acquire(blocking=False):
            return
        waits_for = None
        try:
            if self._done:
                return
            self._executing = True
            waits_for = self._step() if inspect.iscoroutine(self._handler) else self._run()
        finally:
            self._executing = False
            self._task_lock.release()
        # Not before the release: who wakes the task may be another thread, and has to find it free.
        if waits_for is not None:
            self._requeue_on(waits_for)

    def _run(self) -> Any:
        """Call the function; return what the coroutine that it returned waits for, or None."""
        try:
            result = self._handler(*self._args, **self._kwargs)
        except Exception as error:
            self.set_exception(error)
            return None
        if inspect.iscoroutine(result):
            self._handler = result
            return self._step()
        self.set_result(result)
        self._complete_task()
        return None

    def _step(self) -> Any:
        """Run the coroutine until it waits; return for what, or None at its end."""
        if self._cancelled:
            self._handler.close()
            return None
        _stepping.count = getattr(_stepping, "count", 0) + 1
        try:
            waits_for = self._handler.send(None)
            return _NOTHING if waits_for is None else waits_for
        except StopIteration as stop:
            self.set_result(stop.value)
        except Exception as error:
            self.set_exception(error)
        finally:
            _stepping.count -= 1
        self._complete_task()
        return None

    def _requeue_on(self, waits_for: Any) -> None:
        """Queue the task again when it can continue."""
        requeue = self._requeue
        if requeue is None:
            return
        if isinstance(waits_for, Future):
            waits_for.on_wake(lambda: requeue(self))
        elif getattr(waits_for, "_asyncio_future_blocking", None):  # an asyncio future, whose loop somebody runs
            waits_for._asyncio_future_blocking = False
            waits_for.add_done_callback(lambda _: requeue(self))
        else:
            requeue(self)  # an awaitable of another kind: ask again

    def _complete_task(self) -> None:
        """Release what the handler refers to."""
        self._handler = None
        self._args, self._kwargs = [], {}

    def executing(self) -> bool:
        """Return whether it is being carried out right now."""
        return self._executing

    def cancel(self) -> None:
        """Cancel the task; a coroutine is closed where it waits."""
        super().cancel()
        if not self._done and inspect.iscoroutine(self._handler) and self._task_lock.acquire(blocking=False):
            try:
                self._handler.close()
            finally:
                self._task_lock.release()
