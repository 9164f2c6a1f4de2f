"""Execution of ready entities' callbacks, within the limits of their callback groups."""

from __future__ import annotations

import inspect
from collections import deque
from collections.abc import Callable, Coroutine, Iterable
from contextlib import AbstractContextManager
from typing import Any

from rclpy.context import Context
from rclpy.impl.ready import ReadyHook
from rclpy.impl.ready_queue import ReadyQueue
from rclpy.impl.running import THREAD, BlockedCalls
from rclpy.task import Future, Task

_AT_ONCE = 20
"""How many messages a subscription may take in a row while nothing else is ready."""


class CallbackRunner:
    """The part of `Executor` that runs callbacks."""

    _helps = True
    """Whether a callback that waits for a response runs other callbacks meanwhile."""

    def __init__(self, context: Context) -> None:
        super().__init__()
        self._context = context
        self._ready = ReadyQueue()
        self._put = self._ready.put
        self._deferred: deque[ReadyHook] = deque()
        self._calls = BlockedCalls()
        self._is_shutdown = False
        self._spins = False  # within `spin`, where nobody counts the callbacks that run

    def create_task(self, callback: Callable[..., Any] | Coroutine[Any, Any, Any], *args: Any, **kwargs: Any) -> Task:
        """Schedule a function or coroutine; see `Executor.create_task`."""
        raise NotImplementedError

    def _help_until_done(self, future: Future, entity: Any, services: Iterable[str], timeout_s: float | None) -> None:
        """Run other callbacks while the one of `entity` waits for a future that one of `services` finishes."""
        raise NotImplementedError

    def _blocked(self, entity: Any, services: Iterable[str]) -> AbstractContextManager[None]:
        """Mark the callback of `entity`, for the length of a block, as waiting for `services`."""
        raise NotImplementedError

    def _begin(self, hook: ReadyHook) -> Any:
        """Reserve the entity's callback group, and return the entity, None when it must wait or is no longer ours."""
        entity = hook.entity()
        if entity is None or hook.sink is not self._put:
            return None  # removed meanwhile; it stays marked and is queued where it is attached next
        group = entity.callback_group
        if group is not None and not group.beginning_execution(entity) and not self._calls.may_enter(entity):
            unbound = getattr(entity, "_rcl_take_unbound", None)
            while unbound is not None and (work := unbound()) is not None:
                work[0](*work[1])
            self._deferred.append(hook)
            if group.can_execute(entity):
                self._retry_deferred()
            return None
        hook.queued = False
        return entity

    def _retry_deferred(self) -> None:
        """Queue again what waited for a callback group."""
        deferred = self._deferred
        while deferred:
            try:
                self._put(deferred.popleft())
            except IndexError:
                return

    def _end(self, entity: Any) -> None:
        group = entity.callback_group
        if group is not None:
            group.ending_execution(entity)
        if self._deferred:
            self._retry_deferred()

    def _run_entity(self, hook: ReadyHook, entity: Any) -> None:
        """Take what is ready and run the callback; its group has been reserved."""
        suspended = False
        thread = THREAD
        outer, thread.running = thread.running, (self, entity)
        in_a_row = self._spins and self._helps
        try:
            for _ in range(_AT_ONCE):
                work = entity._rcl_take()
                if work is None:
                    return
                if not in_a_row and entity._rcl_has_more():
                    hook()
                callback, arguments = work
                result = callback(*arguments)
                if result is not None and inspect.iscoroutine(result):
                    suspended = self._run_coroutine(result, entity)
                if not in_a_row or suspended or not entity._rcl_has_more() or not self._may_run_again(hook):
                    return
        finally:
            thread.running = outer
            if in_a_row and entity._rcl_has_more():
                hook()
            if not suspended:
                self._end(entity)

    def _may_run_again(self, hook: ReadyHook) -> bool:
        """Return whether the entity that just ran may run again before all others."""
        return self._ready.empty() and hook.sink is self._put and not self._is_shutdown and self._context.ok()

    def _run_coroutine(self, coroutine: Coroutine[Any, Any, Any], entity: Any) -> bool:
        """Run a callback that is a coroutine; True when it waits for something and so holds its group."""
        task = Task(coroutine, executor=self)
        task._requeue = self._put
        task._entity = entity
        task()
        if task.done():
            _raise_from(task)
            return False
        task.on_wake(lambda: self._end(entity))
        return True

    def _run_task(self, task: Task) -> None:
        thread = THREAD
        outer, thread.running = thread.running, (self, task._entity)
        try:
            task()
        finally:
            thread.running = outer
        if task.done():
            _raise_from(task)


def _raise_from(task: Task) -> None:
    error = task.exception()
    if error is not None:
        raise error
