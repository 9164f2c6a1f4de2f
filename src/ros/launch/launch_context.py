"""State of a launch: configurations, environment, locals, event handlers and events."""

from __future__ import annotations

import asyncio
import os
from collections import deque
from collections.abc import Iterable, Mapping, MutableMapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from logging import Logger

    from .event import Event
    from .event_handler import BaseEventHandler
    from .substitution import Substitution


class LaunchContext:
    """The state that actions, conditions and substitutions read and change.

    Parameters
    ----------
    argv
        What the user passed to the launch; None means nothing.
    noninteractive
        Whether nobody sits at a terminal, so that Ctrl-C never reaches the processes by itself.
    """

    def __init__(self, *, argv: Iterable[str] | None = None, noninteractive: bool = False) -> None:
        self.__argv = [] if argv is None else list(argv)
        self.__noninteractive = noninteractive
        self.__is_shutdown = False
        self.__asyncio_loop: asyncio.AbstractEventLoop | None = None
        self.__logger: Logger | None = None

        self._event_queue: asyncio.Queue[Event | None] = asyncio.Queue()
        self._event_handlers: deque[BaseEventHandler] = deque()
        self._completion_futures: list[asyncio.Future[None]] = []

        self.__globals: dict[str, Any] = {}
        self.__locals: dict[str, Any] = {}
        self.__locals_stack: list[dict[str, Any]] = []
        self.__launch_configurations: dict[str, Any] = {}
        self.__launch_configurations_stack: list[dict[str, Any]] = []
        self.__initial_environment = dict(os.environ)
        self.__environment_stack: list[dict[str, str]] = []

    @property
    def argv(self) -> list[str]:
        """What the user passed to the launch."""
        return self.__argv

    @property
    def noninteractive(self) -> bool:
        """Whether nobody sits at a terminal."""
        return self.__noninteractive

    # State of the launch service ------------------------------------------------------------------

    @property
    def is_shutdown(self) -> bool:
        """Whether the launch is being stopped."""
        return self.__is_shutdown

    def _set_is_shutdown(self, state: bool) -> None:
        self.__is_shutdown = state

    @property
    def asyncio_loop(self) -> asyncio.AbstractEventLoop | None:
        """The event loop that the launch runs in, None while it does not run."""
        return self.__asyncio_loop

    @property
    def running_loop(self) -> asyncio.AbstractEventLoop:
        """The event loop that the launch runs in; RuntimeError while it does not run."""
        if self.__asyncio_loop is None:
            raise RuntimeError("the launch does not run: there is no event loop yet")
        return self.__asyncio_loop

    def _set_asyncio_loop(self, loop: asyncio.AbstractEventLoop | None) -> None:
        self.__asyncio_loop = loop

    def add_completion_future(self, completion_future: asyncio.Future[None]) -> None:
        """Extend the launch until this future is done, too."""
        self._completion_futures.append(completion_future)
        completion_future.add_done_callback(lambda _: self._wake())

    def _wake(self) -> None:
        """Wake the launch service, which checks whether anything is left to do."""
        self._event_queue.put_nowait(None)

    # Variables ------------------------------------------------------------------------------------

    @property
    def locals(self) -> _Locals:
        """The variables of the present scope as attributes."""
        return _Locals({**self.__globals, **self.__locals})

    def get_locals_as_dict(self) -> dict[str, Any]:
        """Return the variables of the present scope."""
        return {**self.__globals, **self.__locals}

    def extend_globals(self, extensions: dict[str, Any]) -> None:
        """Set variables that every scope sees."""
        self.__globals.update(extensions)

    def extend_locals(self, extensions: dict[str, Any]) -> None:
        """Set variables of the present scope."""
        self.__locals.update(extensions)

    def _remove_local(self, name: str) -> None:
        self.__locals.pop(name, None)

    def _push_locals(self) -> None:
        self.__locals_stack.append(dict(self.__locals))

    def _pop_locals(self) -> None:
        self.__locals = _pop(self.__locals_stack, "locals")

    @property
    def launch_configurations(self) -> dict[str, Any]:
        """The launch configurations of the present scope: texts, and lists that launch_ros keeps there."""
        return self.__launch_configurations

    def _push_launch_configurations(self) -> None:
        self.__launch_configurations_stack.append(dict(self.__launch_configurations))

    def _pop_launch_configurations(self) -> None:
        self.__launch_configurations = _pop(self.__launch_configurations_stack, "launch configurations")

    @property
    def environment(self) -> MutableMapping[str, str]:
        """The environment that processes are started with."""
        return os.environ

    def _push_environment(self) -> None:
        self.__environment_stack.append(dict(os.environ))

    def _pop_environment(self) -> None:
        self.__replace_environment(_pop(self.__environment_stack, "environment"))

    def _reset_environment(self) -> None:
        """Restore the environment that the context was created with."""
        self.__replace_environment(self.__initial_environment)

    def __replace_environment(self, environment: Mapping[str, str]) -> None:
        os.environ.clear()
        os.environ.update(environment)

    # Events ---------------------------------------------------------------------------------------

    def would_handle_event(self, event: Event) -> bool:
        """Return whether any handler is for this event."""
        # Another thread may add or remove handlers meanwhile.
        return any(handler.matches(event) for handler in tuple(self._event_handlers))

    def register_event_handler(self, event_handler: BaseEventHandler, append: bool = False) -> None:
        """Add an event handler before the others, or after them if `append`."""
        if append:
            self._event_handlers.append(event_handler)
        else:
            self._event_handlers.appendleft(event_handler)

    def unregister_event_handler(self, event_handler: BaseEventHandler) -> None:
        """Remove an event handler.

        Raises
        ------
        ValueError
            If it is not registered.
        """
        self._event_handlers.remove(event_handler)

    def emit_event_sync(self, event: Event) -> None:
        """Queue an event; may be called from any thread."""
        self.__debug("emitting event synchronously: '%s'", event.name)
        loop = self.__asyncio_loop
        if loop is None or not loop.is_running() or loop is _running_loop():
            self._event_queue.put_nowait(event)
        else:
            loop.call_soon_threadsafe(self._event_queue.put_nowait, event)

    async def emit_event(self, event: Event) -> None:
        """Queue an event from a coroutine of the launch's own event loop."""
        self.__debug("emitting event: '%s'", event.name)
        await self._event_queue.put(event)

    def __debug(self, message: str, *args: object) -> None:
        if self.__logger is None:
            from .logging import get_logger

            self.__logger = get_logger("launch.launch_context")
        self.__logger.debug(message, *args)

    # Substitutions --------------------------------------------------------------------------------

    def perform_substitution(self, substitution: Substitution) -> str:
        """Evaluate the text of a substitution."""
        return substitution.perform(self)


class _Locals:
    """Variables as attributes."""

    def __init__(self, variables: dict[str, Any]) -> None:
        self.__dict__.update(variables)

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError(f"the local '{name}' is set by LaunchContext.extend_locals, not as an attribute")

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(f"there is no '{name}' among the launch context's locals")


def _pop(stack: list[Any], what: str) -> Any:
    if not stack:
        raise RuntimeError(f"cannot pop {what}: none were pushed")
    return stack.pop()


def _running_loop() -> asyncio.AbstractEventLoop | None:
    try:
        return asyncio.get_running_loop()
    except RuntimeError:
        return None
