"""The action that runs a coroutine."""

from __future__ import annotations

import asyncio
import inspect
from collections.abc import Awaitable, Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any

from ..action import Action
from ..event import Event
from ..event_handlers import OnShutdown
from ..launch_description_entity import LaunchDescriptionEntity
from ..utilities import ensure_argument_type

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


class OpaqueCoroutine(Action):
    """Action that runs a coroutine in the launch's event loop.

    The launch goes on until it is done, and stopping the launch cancels it.

    Parameters
    ----------
    coroutine
        A coroutine function, called as `coroutine(context, *args, **kwargs)`.
    args, kwargs
        What it gets besides the context.
    ignore_context
        Leave the context out.
    **left_over_kwargs
        As for `Action`.
    """

    def __init__(
        self,
        *,
        coroutine: Callable[..., Awaitable[None]],
        args: Iterable[Any] | None = None,
        kwargs: Mapping[str, Any] | None = None,
        ignore_context: bool = False,
        **left_over_kwargs: Any,
    ) -> None:
        super().__init__(**left_over_kwargs)
        if not inspect.iscoroutinefunction(coroutine):
            raise TypeError(f"OpaqueCoroutine expected a coroutine function for 'coroutine', got '{type(coroutine)}'")
        ensure_argument_type(args, (Iterable, type(None)), "args", "OpaqueCoroutine")
        ensure_argument_type(kwargs, (Mapping, type(None)), "kwargs", "OpaqueCoroutine")
        ensure_argument_type(ignore_context, bool, "ignore_context", "OpaqueCoroutine")
        self.__coroutine = coroutine
        self.__args = list(args or [])
        self.__kwargs = dict(kwargs or {})
        self.__ignore_context = ignore_context
        self.__task: asyncio.Task[None] | None = None

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Start the coroutine."""
        args = self.__args if self.__ignore_context else [context, *self.__args]
        self.__task = context.running_loop.create_task(self.__coroutine(*args, **self.__kwargs))
        context.register_event_handler(OnShutdown(on_shutdown=self.__on_shutdown))
        return None

    def __on_shutdown(self, event: Event, context: LaunchContext) -> None:
        if self.__task is not None:
            self.__task.cancel()

    def get_asyncio_future(self) -> asyncio.Future[None] | None:
        """Return the coroutine's task."""
        return self.__task
