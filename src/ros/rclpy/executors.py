"""Executors: they wait until something is ready and run its callback.

Nothing is polled. Whatever becomes ready puts itself, once, into its executor's queue (`rclpy.impl.ready`), timers
stand there by deadline, and the waiting thread sleeps until one or the other wakes it (`rclpy.impl.ready_queue`).
"""

from __future__ import annotations

import inspect
import math
import threading
import time
import warnings
import weakref
from collections.abc import Callable, Coroutine, Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager
from typing import TYPE_CHECKING, Any, Self

from rclpy.context import Context
from rclpy.exceptions import ExternalShutdownException as ExternalShutdownException
from rclpy.impl.callback_runner import CallbackRunner
from rclpy.impl.lazy_reexport import lazy_reexport
from rclpy.impl.ready import ReadyHook
from rclpy.impl.thread_pool import ThreadPool, processors
from rclpy.task import Future, Task
from rclpy.utilities import get_default_context

if TYPE_CHECKING:
    from rclpy.node import Node


async def await_or_execute(callback: Callable[..., Any] | Coroutine[Any, Any, Any], *args: Any) -> Any:
    """Call a function, or await a coroutine function, with these arguments."""
    if inspect.iscoroutinefunction(callback):
        return await callback(*args)
    return callback(*args)  # type: ignore[operator]


class TimeoutException(Exception):
    """Nothing became ready in time."""


class ShutdownException(Exception):
    """The executor was shut down."""


class ConditionReachedException(Exception):
    """The awaited condition has come true."""


class TimeoutObject:
    """A timeout in seconds that counts down from its creation."""

    def __init__(self, timeout: float) -> None:
        self._deadline = math.inf if timeout is None or timeout < 0 else time.monotonic() + timeout

    @property
    def timeout(self) -> float:
        """What is left of it."""
        return max(self._deadline - time.monotonic(), 0.0)


class _Failure:
    """An exception on its way from a worker to the thread that spins."""

    def __init__(self, error: BaseException) -> None:
        self.error = error


class Executor(CallbackRunner, AbstractContextManager["Executor"]):
    """Base of executors.

    Parameters
    ----------
    context
        The default context where None.
    """

    def __init__(self, *, context: Context | None = None) -> None:
        super().__init__(context or get_default_context())
        self._nodes: dict[Node, None] = {}
        self._nodes_lock = threading.RLock()
        self._schedule = self._ready.schedule
        self._active = 0
        self._idle = threading.Condition()
        self._context.on_shutdown(self.wake)

    @property
    def context(self) -> Context:
        """The executor's context."""
        return self._context

    # Tasks and nodes.

    def create_task(self, callback: Callable[..., Any] | Coroutine[Any, Any, Any], *args: Any, **kwargs: Any) -> Task:
        """Schedule a function or coroutine, and return the task, whose result it will be."""
        task = Task(callback, args, kwargs, executor=self)
        task._requeue = self._put
        self._ready.put_first(task)
        return task

    def create_future(self) -> Future:
        """Return a future whose callbacks this executor calls."""
        return Future(executor=self)

    def add_node(self, node: Node) -> bool:
        """Run a node's callbacks from now on; False when they are already.

        Raises
        ------
        ShutdownException
            When the executor was shut down.
        """
        with self._nodes_lock:
            if node in self._nodes:
                return False
            if self._is_shutdown:
                raise ShutdownException()
            self._nodes[node] = None
        self._ready.receiver = node.handle.session.backend.receiver
        node._rcl_attach_executor(self)
        return True

    def remove_node(self, node: Node) -> None:
        """Run a node's callbacks no more."""
        with self._nodes_lock:
            if node not in self._nodes:
                return
            del self._nodes[node]
        node._rcl_detach_executor(self)

    def _forget(self, node: Node) -> None:
        """Remove a node that is being destroyed."""
        with self._nodes_lock:
            self._nodes.pop(node, None)
        node._rcl_detach_executor(self)

    def get_nodes(self) -> list[Node]:
        """Return the nodes whose callbacks are run."""
        with self._nodes_lock:
            return list(self._nodes)

    def wake(self) -> None:
        """Wake the waiting thread, so that it checks again what it waits for."""
        self._put(None)

    def shutdown(self, timeout_sec: float | None = None) -> bool:
        """Stop, after the callbacks that run have ended.

        Returns
        -------
        bool
            Whether they ended within `timeout_sec` seconds (None or negative: however long it takes).
        """
        self._is_shutdown = True
        self.wake()
        for node in self.get_nodes():
            self.remove_node(node)
        timeout = None if timeout_sec is None or timeout_sec < 0 else timeout_sec
        with self._idle:
            return self._idle.wait_for(lambda: self._active == 0, timeout)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exception: object) -> None:
        self.shutdown()

    def __del__(self) -> None:
        self._is_shutdown = True

    # Spinning.

    def spin(self) -> None:
        """Run callbacks until the executor or the context is shut down.

        Raises
        ------
        ExternalShutdownException
            When the context was shut down.
        """
        self._spins = True
        try:
            while self._context.ok() and not self._is_shutdown:
                self._run_one(None, None)
        finally:
            self._spins = False

    def spin_until_future_complete(self, future: Future, timeout_sec: float | None = None) -> None:
        """Run callbacks until a future is done or cancelled, for at most `timeout_sec` seconds."""
        future.on_wake(self.wake)
        deadline = _deadline(timeout_sec)
        while self._context.ok() and not future._pending_over() and not self._is_shutdown:
            self._run_one(deadline, future._pending_over)
            if deadline is not None and time.monotonic_ns() >= deadline:
                return

    def _run_one(self, deadline_ns: int | None, condition: Callable[[], bool] | None) -> None:
        """Run one callback, the way of a user's executor when it has one."""
        if type(self).spin_once is Executor.spin_once:
            self._spin_once(deadline_ns, condition)
        else:
            left = None if deadline_ns is None else max(0, deadline_ns - time.monotonic_ns()) * 1e-9
            self.spin_once(timeout_sec=left)

    def _spin_once(self, deadline_ns: int | None, condition: Callable[[], bool] | None) -> None:
        """Run one callback, unless the deadline or the condition comes first."""
        try:
            while True:
                item = self._wait(deadline_ns, condition)
                if item.__class__ is ReadyHook:
                    entity = self._begin(item)
                    if entity is not None:
                        self._carry_out_entity(item, entity)
                        return
                elif isinstance(item, _Failure):
                    raise item.error
                else:
                    self._carry_out(self._run_task, item)
                    return
        except (TimeoutException, ShutdownException, ConditionReachedException):
            return

    def _carry_out(self, function: Callable[..., None], *arguments: Any) -> None:
        """Run a callback, here or in a thread of its own."""
        raise NotImplementedError

    def _carry_out_entity(self, hook: ReadyHook, entity: Any) -> None:
        """Run the callback of an entity as `_carry_out` does."""
        self._carry_out(self._run_entity, hook, entity)

    def spin_once(self, timeout_sec: float | None = None) -> None:
        """Run one callback; wait for it at most `timeout_sec` seconds (None: however long it takes).

        It is all that an executor of one's own has to replace; `wait_for_ready_callbacks` gives it work.
        """
        self._spin_once(_deadline(timeout_sec), None)

    def spin_once_until_future_complete(self, future: Future, timeout_sec: float | TimeoutObject | None = None) -> None:
        """Run one callback unless the future is done or cancelled first."""
        future.on_wake(self.wake)
        self._run_one(_deadline(timeout_sec), future._pending_over)

    def can_execute(self, entity: Any) -> bool:
        """Return whether the entity's callback group allows it to run now."""
        group = entity.callback_group
        return group is None or group.can_execute(entity)

    def wait_for_ready_callbacks(
        self,
        timeout_sec: float | TimeoutObject | None = None,
        nodes: list[Node] | None = None,
        condition: Callable[[], bool] = lambda: False,
    ) -> tuple[Task, Any, Node | None]:
        """Return the next callback that is ready, as a task, with its entity and node.

        Raises
        ------
        TimeoutException, ShutdownException, ExternalShutdownException, ConditionReachedException
            When one of these comes first.
        """
        while True:
            item = self._wait(_deadline(timeout_sec), condition)
            if isinstance(item, Task):
                return item, None, None
            if isinstance(item, _Failure):
                raise item.error
            entity = self._begin(item)
            if entity is not None:
                node = entity._rcl_node() if entity._rcl_node is not None else None
                return Task(self._run_entity, (item, entity), executor=self), entity, node

    def _wait_for_ready_callbacks(self, *args: Any, **kwargs: Any) -> Iterator[tuple[Task, Any, Node | None]]:
        """Yield what `wait_for_ready_callbacks` returns, for ever."""
        while True:
            yield self.wait_for_ready_callbacks(*args, **kwargs)

    def _help_until_done(self, future: Future, entity: Any, services: Iterable[str], timeout_s: float | None) -> None:
        """Run other callbacks while the one of `entity` waits for a future that one of `services` finishes."""
        future.on_wake(self.wake)
        deadline = _deadline(timeout_s)
        with self._blocked(entity, services):
            while not future._pending_over() and not self._is_shutdown:
                if deadline is not None and time.monotonic_ns() >= deadline:
                    return
                self._spin_once(deadline, future._pending_over)

    @contextmanager
    def _blocked(self, entity: Any, services: Iterable[str]) -> Iterator[None]:
        """Mark the callback of `entity`, for the length of a block, as waiting for `services`."""
        with self._calls.waiting(services, entity.callback_group if entity is not None else None):
            self._retry_deferred()
            if entity is not None and entity._rcl_has_more():
                entity._rcl_hook()
            yield

    def _wait(self, deadline_ns: int | None, condition: Callable[[], bool] | None = None) -> Any:
        """Return the next hook, task or failure of the queue."""
        self._check(condition)
        while True:
            try:
                item = self._ready.get(deadline_ns)
            except TimeoutError:
                raise TimeoutException() from None
            if item is not None:
                return item
            self._check(condition)

    def _check(self, condition: Callable[[], bool] | None) -> None:
        if self._is_shutdown:
            raise ShutdownException()
        if not self._context.ok():
            raise ExternalShutdownException()
        if condition is not None and condition():
            raise ConditionReachedException()


def _deadline(timeout_sec: float | TimeoutObject | None) -> int | None:
    """Return when a timeout ends, by ``time.monotonic_ns()``."""
    if isinstance(timeout_sec, TimeoutObject):
        timeout_sec = timeout_sec.timeout
    if timeout_sec is None or timeout_sec < 0 or timeout_sec == math.inf:
        return None
    return time.monotonic_ns() + int(timeout_sec * 1e9)


class SingleThreadedExecutor(Executor):
    """Executor that runs callbacks one after the other in the thread that spins."""

    def _carry_out(self, function: Callable[..., None], *arguments: Any) -> None:
        function(*arguments)

    def _carry_out_entity(self, hook: ReadyHook, entity: Any) -> None:
        self._run_entity(hook, entity)  # without packing arguments, as it is done for each message


class MultiThreadedExecutor(Executor):
    """Executor that runs callbacks in a pool of threads, as far as callback groups allow.

    Parameters
    ----------
    num_threads
        How many callbacks run at a time; as many as it may use processors (at least 2) where None. Those that wait
        for a response do not count.
    context
        The default context where None.
    """

    _helps = False

    def __init__(self, num_threads: int | None = None, *, context: Context | None = None) -> None:
        super().__init__(context=context)
        if num_threads == 1:
            warnings.warn("A MultiThreadedExecutor of one thread: use a SingleThreadedExecutor.", stacklevel=2)
        self._executor = ThreadPool(num_threads or max(processors(), 2))
        weakref.finalize(self, self._executor.close)

    @contextmanager
    def _blocked(self, entity: Any, services: Iterable[str]) -> Iterator[None]:
        with super()._blocked(entity, services), self._executor.blocked():
            yield

    def _carry_out(self, function: Callable[..., None], *arguments: Any) -> None:
        with self._idle:
            self._active += 1
        self._executor.submit(self._work, function, *arguments)

    def _work(self, function: Callable[..., None], *arguments: Any) -> None:
        try:
            function(*arguments)
        except BaseException as error:
            self._put(_Failure(error))
        finally:
            with self._idle:
                self._active -= 1
                if self._active == 0:
                    self._idle.notify_all()

    def shutdown(self, timeout_sec: float | None = None, *, wait_for_threads: bool = True) -> bool:
        """Stop, after the callbacks that run have ended; see `Executor.shutdown`.

        Parameters
        ----------
        timeout_sec
            Time in which they must end, in seconds.
        wait_for_threads
            Whether to wait until the threads have ended too, unless a callback has not ended in time.
        """
        ended = super().shutdown(timeout_sec)
        self._executor.close()
        if ended and wait_for_threads:
            self._executor.join()
        return ended


if not TYPE_CHECKING:
    __getattr__ = lazy_reexport(
        __name__,
        {
            "concurrent.futures": ("ThreadPoolExecutor",),
            "rclpy.client": ("Client",),
            "rclpy.clock": ("Clock", "ClockType"),
            "rclpy.guard_condition": ("GuardCondition",),
            "rclpy.handle": ("InvalidHandle",),
            "rclpy.node": ("Node",),
            "rclpy.service": ("Service",),
            "rclpy.signals": ("SignalHandlerGuardCondition",),
            "rclpy.subscription": ("Subscription",),
            "rclpy.timer": ("Timer",),
            "rclpy.utilities": ("timeout_sec_to_nsec",),
            "rclpy.waitable": ("NumberOfEntities", "Waitable"),
        },
    )
