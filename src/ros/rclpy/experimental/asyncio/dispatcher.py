"""Dispatcher of callbacks in an asyncio event loop, in place of an executor."""

from __future__ import annotations

import asyncio
import inspect
from collections.abc import Callable
from typing import Any

from rclpy.experimental.asyncio.loops import post
from rclpy.impl.ready import ReadyHook
from rclpy.impl.timer import TimerHandle
from rclpy.task import Task


class Dispatcher:
    """Dispatcher that runs the callbacks of what becomes ready, on whatever thread, as tasks of one group.

    Parameters
    ----------
    loop
        The event loop.
    group
        Takes the tasks; an exception of a callback ends it.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop, group: asyncio.TaskGroup) -> None:
        self._loop = loop
        self._group = group
        self._tasks: set[asyncio.Task[None]] = set()
        self._busy: set[ReadyHook] = set()
        self._closed = False

    def close(self) -> None:
        """Run nothing more, and cancel what runs; the callback that calls this goes on."""
        self._closed = True
        current = asyncio.current_task(self._loop) if _is_running(self._loop) else None
        for task in self._tasks - {current}:
            task.cancel()

    # What a node asks of its executor.

    def _put(self, item: Any) -> None:
        post(self._loop, self._dispatch, item)

    def _schedule(self, deadline_ns: int, timer: TimerHandle) -> None:
        self._put((deadline_ns, timer, timer.version))

    def wake(self) -> None:
        """Accept the call without effect: no thread waits."""

    def remove_node(self, node: Any) -> None:
        """Detach the node."""
        node._rcl_detach_executor(self)

    _forget = remove_node

    def create_task(self, callback: Any, *args: Any, **kwargs: Any) -> Task:
        """Schedule a function or coroutine, and return the task, whose result it will be."""
        task = Task(callback, args, kwargs)
        task._requeue = self._put
        self._put(task)
        return task

    # On the loop.

    def _dispatch(self, item: Any) -> None:
        if self._closed:
            return
        if isinstance(item, ReadyHook):
            if item not in self._busy:
                self._busy.add(item)
                self._start(self._serve(item))
        elif isinstance(item, Task):
            item()
            if item.done() and item.exception() is not None:
                self._start(_fail(item))
        else:
            deadline_ns, timer, version = item
            self._loop.call_at(deadline_ns / 1e9, self._tell, timer, version)

    def _tell(self, timer: TimerHandle, version: int) -> None:
        if timer.version == version:
            timer.on_due()

    def _start(self, work: Any) -> None:
        task = self._group.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _serve(self, hook: ReadyHook) -> None:
        """Run an entity's callbacks, one after the other unless it is concurrent, until nothing is ready."""
        try:
            while not self._closed:
                hook.queued = False
                entity = hook.entity()
                work = entity._rcl_take() if entity is not None else None
                if work is None:
                    return
                callback, arguments = work
                if getattr(entity, "concurrent", False):
                    self._start(_call(callback, arguments))
                else:
                    await _call(callback, arguments)
                await asyncio.sleep(0)  # what is always ready lets others run
        finally:
            self._busy.discard(hook)
            if hook.queued:
                self._put(hook)


async def _call(callback: Callable[..., Any], arguments: tuple[Any, ...]) -> None:
    result = callback(*arguments)
    if inspect.isawaitable(result):
        await result


async def _fail(task: Task) -> None:
    task.result()


def _is_running(loop: asyncio.AbstractEventLoop) -> bool:
    try:
        return asyncio.get_running_loop() is loop
    except RuntimeError:
        return False
