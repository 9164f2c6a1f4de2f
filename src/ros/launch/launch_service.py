"""The launch service: visits launch descriptions and hands events to their handlers until all is done."""

from __future__ import annotations

import asyncio
import collections.abc
import contextlib
import logging
import signal
import threading
import traceback
from collections.abc import Coroutine, Iterable, Iterator, Sequence
from typing import Any

from .event import Event
from .event_handlers import OnIncludeLaunchDescription, OnShutdown
from .events import IncludeLaunchDescription, Shutdown
from .events.process import SignalProcess
from .launch_context import LaunchContext
from .launch_description import LaunchDescription
from .launch_description_entity import LaunchDescriptionEntity
from .launch_file_error import LaunchFileError
from .logging import get_logger, launch_config, log_launch_config
from .utilities import AsyncSafeSignalManager, is_a_subclass, visit_all_entities_and_collect_futures

_KILL_TIMEOUT = 2.0
_running: list[LaunchService] = []
_main_loop: asyncio.AbstractEventLoop | None = None


def running_services() -> Sequence[LaunchService]:
    """Return the services of this process that run, in the order in which they began."""
    return tuple(_running)


class LaunchService:
    """Service that runs launch descriptions.

    Parameters
    ----------
    argv
        What the user passed to the launch, for entities that ask the context for it.
    noninteractive
        Whether nobody sits at a terminal.
    debug
        Whether everything that happens is logged.
    """

    def __init__(self, *, argv: Iterable[str] | None = None, noninteractive: bool = False, debug: bool = False) -> None:
        if debug:
            launch_config.level = logging.DEBUG
        self.__logger = get_logger("launch")
        log_launch_config(logger=self.__logger)
        self.__context = LaunchContext(argv=argv, noninteractive=noninteractive)
        self.__context.register_event_handler(OnIncludeLaunchDescription())
        self.__context.register_event_handler(OnShutdown(on_shutdown=self.__on_shutdown))
        self.__entity_future_pairs: list[tuple[LaunchDescriptionEntity, asyncio.Future[Any]]] = []
        self.__lock = threading.RLock()
        self.__loop: asyncio.AbstractEventLoop | None = None
        self.__thread: int | None = None
        self.__task: asyncio.Task[int] | None = None
        # An emitted shutdown is only handled after the events that were queued before it.
        self.__shutdown_emitted = False
        self.__shutting_down = False
        self.__return_code = 0
        self.__interrupts = 0
        self.__interrupted = False
        self.__error: LaunchFileError | None = None

    @property
    def context(self) -> LaunchContext:
        """The launch context."""
        return self.__context

    @property
    def event_loop(self) -> asyncio.AbstractEventLoop | None:
        """The event loop that the service runs in, None while it does not run."""
        return self.__loop

    @property
    def task(self) -> asyncio.Task[int] | None:
        """The task that the service runs in, None while it does not run."""
        return self.__task

    @property
    def error(self) -> LaunchFileError | None:
        """The first mistake that ended the launch, with its file and line; None if there was none."""
        return self.__error

    @property
    def was_interrupted(self) -> bool:
        """Whether SIGINT (Ctrl-C) came during the last `run`, whatever ended it."""
        return self.__interrupted

    def emit_event(self, event: Event) -> None:
        """Queue an event; may be called from any thread."""
        self.__context.emit_event_sync(event)

    def include_launch_description(self, launch_description: LaunchDescription) -> None:
        """Visit a launch description; may be called from any thread."""
        self.emit_event(IncludeLaunchDescription(launch_description))

    # Running --------------------------------------------------------------------------------------

    def run(self, *, shutdown_when_idle: bool = True) -> int:
        """Run until the launch is over.

        In the main thread the first SIGINT or SIGTERM stops the launch in order, each further one goes a step
        harder (SIGTERM, then SIGKILL, to all processes that are left), and SIGQUIT kills them at once.

        Parameters
        ----------
        shutdown_when_idle
            Whether the launch is over when nothing is left to do; otherwise only `shutdown` ends it.

        Returns
        -------
            0, or 1 after an error.
        """
        self.__interrupted = False
        with _event_loop() as loop:
            return self.__run_in(loop, shutdown_when_idle)

    def __run_in(self, loop: asyncio.AbstractEventLoop, shutdown_when_idle: bool) -> int:
        task = loop.create_task(self.run_async(shutdown_when_idle=shutdown_when_idle))
        while True:
            try:
                return loop.run_until_complete(task)
            except KeyboardInterrupt:
                # It came in the moment before the signal handlers were in place, or after they were removed.
                self.__interrupted = True
                if not task.done():
                    self.__interrupt("ctrl-c (SIGINT)")

    async def run_async(self, *, shutdown_when_idle: bool = True) -> int:
        """Run until the launch is over, inside an event loop; see `run`."""
        with self.__running():
            try:
                await self.__process_until_done(shutdown_when_idle)
            except asyncio.CancelledError:
                self.__logger.error("run task was canceled")
                # Nobody will be there to wait for the processes.
                self.__process(Shutdown(reason="run task was canceled"))
                self.__process(SignalProcess(signal_number="SIGKILL", process_matcher=lambda _: True))
                self.__return_code = 1
                with contextlib.suppress(TimeoutError):
                    async with asyncio.timeout(_KILL_TIMEOUT):
                        await self.__process_until_done(shutdown_when_idle)
        return self.__return_code

    async def __process_until_done(self, shutdown_when_idle: bool) -> None:
        while True:
            # What has just ended may have something to say about it.
            await asyncio.sleep(0)
            if self._is_idle():
                if self.__shutting_down:
                    return
                if shutdown_when_idle:
                    self.__emit_shutdown("idle", due_to_sigint=False)
            event = await self.__context._event_queue.get()
            # None only says that something ended.
            if event is not None:
                self.__process(event)

    @contextlib.contextmanager
    def __running(self) -> Iterator[None]:
        loop = asyncio.get_running_loop()
        with self.__lock:
            if self.__loop is not None:
                raise RuntimeError("LaunchService is already running")
            self.__loop = loop
            self.__thread = threading.get_ident()
            self.__task = asyncio.current_task()
        self.__context._set_asyncio_loop(loop)
        self.__context._set_is_shutdown(False)
        self.__shutdown_emitted = self.__shutting_down = False
        self.__return_code = 0
        self.__interrupts = 0
        self.__error = None
        _running.append(self)
        try:
            with self.__signals(loop):
                yield
        finally:
            _running.remove(self)
            with self.__lock:
                self.__loop = None
                self.__task = None
            self.__context._set_asyncio_loop(None)
            self.__shutdown_emitted = self.__shutting_down = False

    @contextlib.contextmanager
    def __signals(self, loop: asyncio.AbstractEventLoop) -> Iterator[None]:
        if threading.current_thread() is not threading.main_thread():
            yield
            return
        with AsyncSafeSignalManager(loop) as manager:
            manager.handle(signal.SIGINT, self.__on_sigint)
            manager.handle(signal.SIGTERM, lambda signum: self.__interrupt("SIGTERM"))
            if hasattr(signal, "SIGHUP"):
                manager.handle(signal.SIGHUP, lambda signum: self.__interrupt("SIGHUP"))
            if hasattr(signal, "SIGQUIT"):
                manager.handle(signal.SIGQUIT, lambda signum: self.__interrupt("ctrl-\\ (SIGQUIT)", at_once=True))
            yield

    def _is_idle(self) -> bool:
        """Return whether nothing is going on and no event waits, as tests of launches ask."""
        futures = self.__context._completion_futures
        futures[:] = [future for future in futures if not self.__has_ended(future)]
        self.__entity_future_pairs = [
            (entity, future) for entity, future in self.__entity_future_pairs if not self.__has_ended(future)
        ]
        return not (futures or self.__entity_future_pairs) and self.__context._event_queue.empty()

    def __has_ended(self, future: asyncio.Future[Any]) -> bool:
        if not future.done():
            return False
        error = None if future.cancelled() else future.exception()
        if error is not None:
            self.__fail(error)
        return True

    # Events ---------------------------------------------------------------------------------------

    def __process(self, event: Event) -> None:
        self.__logger.debug("processing event: '%s'", event)
        if isinstance(event, Shutdown):
            self.__shutdown_emitted = self.__shutting_down = True
        try:
            for handler in tuple(self.__context._event_handlers):
                if handler.matches(event):
                    self.__logger.debug("processing event: '%s' ✓ '%s'", event, handler)
                    self.__handle(event, handler)
                else:
                    self.__logger.debug("processing event: '%s' x '%s'", event, handler)
        # Whatever goes wrong in a launch file ends this launch in order.
        except Exception as error:
            self.__fail(error)

    def __handle(self, event: Event, handler: Any) -> None:
        self.__context._push_locals()
        try:
            entities = handler.handle(event, self.__context)
            if not isinstance(entities, collections.abc.Iterable):
                entities = [] if entities is None else [entities]
            for entity in [entity for entity in entities if entity is not None]:
                if not is_a_subclass(entity, LaunchDescriptionEntity):
                    raise RuntimeError(f"expected a LaunchDescriptionEntity from event_handler, got '{entity}'")
                self.__visit(entity)
        finally:
            self.__context._pop_locals()

    def __visit(self, entity: LaunchDescriptionEntity) -> None:
        for pair in visit_all_entities_and_collect_futures(entity, self.__context):
            pair[1].add_done_callback(lambda _: self.__context._wake())
            self.__entity_future_pairs.append(pair)

    def __fail(self, error: BaseException) -> None:
        self.__logger.debug("".join(traceback.format_exception(error)))
        located = LaunchFileError.from_exception(error)
        message = f"Caught exception in launch (see debug for traceback): {located}"
        self.__logger.error(message)
        self.__error = self.__error or located
        self.__return_code = 1
        self.__emit_shutdown(message, due_to_sigint=False)

    # Stopping -------------------------------------------------------------------------------------

    def shutdown(self, force_sync: bool = False) -> Coroutine[Any, Any, None] | None:
        """Stop the launch in order; does nothing if it does not run. May be called from any thread.

        Parameters
        ----------
        force_sync
            Return None even inside the launch's own event loop.

        Returns
        -------
            In the thread of the launch's event loop a coroutine to await, whether or not the loop runs at the
            moment; elsewhere None.
        """
        with self.__lock:
            loop = self.__loop
            if loop is None:
                return None
            self.__emit_shutdown("LaunchService.shutdown() called", due_to_sigint=False)
        if force_sync or threading.get_ident() != self.__thread:
            return None
        return asyncio.sleep(0)

    def __emit_shutdown(self, reason: str, *, due_to_sigint: bool) -> None:
        if not self.__shutdown_emitted:
            self.__shutdown_emitted = True
            self.__context.emit_event_sync(Shutdown(reason=reason, due_to_sigint=due_to_sigint))

    def __on_shutdown(self, event: Event, context: LaunchContext) -> None:
        context._set_is_shutdown(True)

    def __on_sigint(self, number: int) -> None:
        self.__interrupted = True
        self.__interrupt("ctrl-c (SIGINT)")

    def __interrupt(self, what: str, *, at_once: bool = False) -> None:
        """React to a signal: stop in order, then harder each time."""
        self.__interrupts += 1
        self.__logger.warning(f"user interrupted with {what}")
        self.__emit_shutdown(what, due_to_sigint="SIGINT" in what)
        harder = {2: "SIGTERM"}.get(self.__interrupts, "SIGKILL") if self.__interrupts > 1 else None
        if at_once:
            harder = "SIGKILL"
        if harder is not None:
            self.__logger.warning(f"sending '{harder}' to all processes that are left")
            self.__context.emit_event_sync(SignalProcess(signal_number=harder, process_matcher=lambda _: True))


@contextlib.contextmanager
def _event_loop() -> Iterator[asyncio.AbstractEventLoop]:
    """Return the event loop of the main thread, which all services run in one after another, or one for once.

    In lock-step, every program of the process has a main thread: the loop may be another one's.
    """
    global _main_loop
    is_taken = _main_loop is not None and _main_loop.is_running()
    if is_taken or threading.current_thread() is not threading.main_thread():
        loop = asyncio.new_event_loop()
        try:
            yield loop
        finally:
            loop.close()
        return
    if _main_loop is None or _main_loop.is_closed():
        _main_loop = asyncio.new_event_loop()
    # Entities of a launch may ask asyncio for the loop that they are in.
    asyncio.set_event_loop(_main_loop)
    yield _main_loop
