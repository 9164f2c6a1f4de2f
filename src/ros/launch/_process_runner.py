"""The life of a process of a launch: started, watched, signalled, and started again if it is to be."""

from __future__ import annotations

import asyncio
import codecs
import signal
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ._process import RunningProcess, process_starter
from .event import Event
from .event_handler import BaseEventHandler
from .events import Shutdown, matches_action
from .events.process import (
    ProcessExited,
    ProcessStarted,
    ProcessStderr,
    ProcessStdin,
    ProcessStdout,
    ProcessTargetedEvent,
    ShutdownProcess,
    SignalProcess,
)
from .logging import get_logger, get_output_loggers
from .some_entities_type import SomeEntitiesType

if TYPE_CHECKING:
    import logging

    from .actions.execute_local import ExecuteLocal
    from .launch_context import LaunchContext

_STOPPING_SIGNALS = {
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGKILL", "SIGQUIT", "SIGHUP") if hasattr(signal, name)
}
_SIGKILL = getattr(signal, "SIGKILL", signal.SIGTERM)


@dataclass(frozen=True)
class RunOptions:
    """Options of a process; each has the meaning of the parameter of `ExecuteLocal`."""

    shell: bool
    emulate_tty: bool
    output: str | Mapping[str, Any]
    output_format: str
    cached_output: bool
    log_cmd: bool
    sigterm_timeout: float
    sigkill_timeout: float
    respawn: bool
    respawn_delay: float
    respawn_max_retries: int

    @property
    def timeouts(self) -> tuple[float, float]:
        """Seconds to wait after SIGINT and after SIGTERM."""
        return self.sigterm_timeout, self.sigkill_timeout


class ProcessRunner:
    """Runner of the process of an action.

    Parameters
    ----------
    action
        The action; its process description is prepared.
    options
        How to run it.
    exit_handler
        Handles the event of the process's end, where somebody wants to react to it.
    context
        The launch context.
    """

    def __init__(
        self,
        action: ExecuteLocal,
        options: RunOptions,
        exit_handler: BaseEventHandler | None,
        context: LaunchContext,
    ) -> None:
        self._action = action
        self._program = action.process_description.prepared
        self._options = options
        self._exit_handler = exit_handler
        self._context = context
        self._logger = get_logger(self._program.name)
        self._loggers = get_output_loggers(self._program.name, options.output)
        self._child: RunningProcess | None = None
        self._life: asyncio.Task[None] | None = None
        self._escalation: asyncio.Task[None] | None = None
        self._stopping: asyncio.Future[None] = context.running_loop.create_future()
        self.completed: asyncio.Future[None] = context.running_loop.create_future()
        program = self._program
        #: `action`, `name`, `cmd`, `cwd` and `env`, and `pid` once there is a process.
        self.details = {
            "action": action,
            "name": program.name,
            "cmd": program.cmd,
            "cwd": program.cwd,
            "env": program.env,
        }
        self.return_code: int | None = None
        self.stdout = TextOutput(keep=options.cached_output)
        self.stderr = TextOutput(keep=options.cached_output)
        self._handler = _ProcessEventHandler(action, self._react)

    def start(self) -> None:
        """Start the process."""
        self._context.register_event_handler(self._handler)
        self._life = self._context.running_loop.create_task(self._run())

    # The life of the process ----------------------------------------------------------------------

    async def _run(self) -> None:
        respawns = 0
        try:
            while await self._run_once() and await self._is_to_respawn(respawns):
                respawns += 1
        finally:
            if not self.completed.done():
                self.completed.set_result(None)

    async def _run_once(self) -> bool:
        """Run the process until it ends; return whether it could be started."""
        if self._stopping.done():
            return False
        program = self._program
        if self._options.log_cmd:
            self._logger.info(f"process details: cmd={program.cmd}, cwd={program.cwd}, shell={self._options.shell}")
        try:
            self._child = await process_starter()(
                program.cmd,
                cwd=program.cwd,
                env=program.env,
                shell=self._options.shell,
                emulate_tty=self._options.emulate_tty,
                on_output=self._on_output,
            )
        except OSError as error:
            command = " ".join(program.cmd)
            self._logger.error(f"process could not be started: {error}, cmd '{command}'")
            return False
        self.details = details = {**self.details, "pid": self._child.pid}
        await self._context.emit_event(ProcessStarted(**details))
        self._logger.info(f"process started with pid [{self._child.pid}]")
        if self._stopping.done():
            # It was asked to stop while it was being started.
            self._stop_child(self._child)
        self.return_code = await self._child.wait()
        await self._stop_escalating()
        await self._after_exit(self._child, self.return_code)
        await self._context.emit_event(ProcessExited(returncode=self.return_code, **details))
        return True

    async def _after_exit(self, child: RunningProcess, code: int) -> None:
        for output, logger in zip((self.stdout, self.stderr), self._loggers, strict=True):
            self._log_lines(logger, output.finish())
        if code == 0:
            self._logger.info(f"process has finished cleanly [pid {child.pid}]")
        else:
            command = " ".join(self._program.cmd)
            self._logger.error(f"process has died [pid {child.pid}, exit code {code}, cmd '{command}'].")
        if self._stopping.done():
            await child.end_group(timeouts=self._options.timeouts, interrupted=True)
        if child.has_leftovers:
            # What the process left running is stopped with the launch.
            self._context.register_event_handler(_LeftoverHandler(child, self._options.timeouts))
        else:
            child.close()

    async def _is_to_respawn(self, respawns: int) -> bool:
        options = self._options
        used_up = 0 <= options.respawn_max_retries <= respawns
        if not options.respawn or used_up or self._context.is_shutdown or self._stopping.done():
            return False
        if options.respawn_delay > 0:
            await asyncio.wait([self._stopping], timeout=options.respawn_delay)
        return not self._stopping.done()

    # What it prints -------------------------------------------------------------------------------

    def _on_output(self, fd: int, data: bytes) -> None:
        output = self.stdout if fd == 1 else self.stderr
        self._log_lines(self._loggers[fd - 1], output.feed(data))
        # On Windows the first piece may come before the process is known to have started.
        if self._child is not None:
            event = (ProcessStdout if fd == 1 else ProcessStderr)(text=data, **self.details)
            if self._context.would_handle_event(event):
                self._context.emit_event_sync(event)

    def _log_lines(self, logger: logging.Logger, lines: list[str]) -> None:
        for line in lines:
            logger.info(self._options.output_format.format(line=line, this=self._action))

    # What happens to it ---------------------------------------------------------------------------

    def _react(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        if isinstance(event, ProcessExited):
            if self.completed.done():
                context.unregister_event_handler(self._handler)
            return None if self._exit_handler is None else self._exit_handler.handle(event, context)
        if isinstance(event, ProcessStdin):
            if self._child is not None and self._child.running:
                self._child.write(event.text)
        elif isinstance(event, SignalProcess):
            self._send_signal(event.signal)
        elif not self._stopping.done():
            self._stopping.set_result(None)
            if self._child is not None and self._child.running:
                self._stop_child(self._child)
        return None

    def _stop_child(self, child: RunningProcess) -> None:
        self._emit_signal(signal.SIGINT)
        self._escalation = self._context.running_loop.create_task(self._escalate(child))

    async def _escalate(self, child: RunningProcess) -> None:
        """Send harder and harder signals until the process has ended."""
        name = self._program.name
        sent = "SIGINT"
        for seconds, signum in zip(self._options.timeouts, (signal.SIGTERM, _SIGKILL), strict=True):
            await asyncio.sleep(seconds)
            if not child.running:
                return
            self._logger.error(
                f"process[{name}] failed to terminate '{seconds:g}' seconds after receiving '{sent}', "
                f"escalating to '{signum.name}'"
            )
            sent = signum.name
            self._emit_signal(signum)

    async def _stop_escalating(self) -> None:
        if self._escalation is not None:
            self._escalation.cancel()
            await asyncio.wait([self._escalation])

    def _emit_signal(self, signum: signal.Signals) -> None:
        self._context.emit_event_sync(SignalProcess(signal_number=signum, process_matcher=matches_action(self._action)))

    def _send_signal(self, signum: signal.Signals) -> None:
        name = self._program.name
        if self._child is None or not self._child.running:
            self._logger.debug(f"signal '{signum.name}' not sent to process[{name}], which does not run")
            return
        self._logger.info(f"sending signal '{signum.name}' to process[{name}]")
        self._child.send_signal(signum, to_group=signum in _STOPPING_SIGNALS)


class TextOutput:
    """Bytes that become lines of text as they come.

    Parameters
    ----------
    keep
        Whether all text is kept.
    """

    def __init__(self, *, keep: bool) -> None:
        self._keep = keep
        self._kept: list[str] = []
        self._line = ""
        self._decoder = codecs.getincrementaldecoder("utf-8")(errors="replace")

    @property
    def text(self) -> str:
        """All text that was kept."""
        return "".join(self._kept)

    def feed(self, data: bytes) -> list[str]:
        """Decode bytes and return the lines that are complete with them."""
        text = self._decoder.decode(data)
        if self._keep:
            self._kept.append(text)
        *lines, self._line = (self._line + text).split("\n")
        return [line.rstrip("\r") for line in lines]

    def finish(self) -> list[str]:
        """Return the last line if no newline came after it."""
        line = self._line + self._decoder.decode(b"", final=True)
        self._line = ""
        self._decoder.reset()
        return [line.rstrip("\r")] if line else []


class _ProcessEventHandler(BaseEventHandler):
    """Event handler that passes the events of a process to its runner."""

    def __init__(self, action: ExecuteLocal, react: Callable[[Event, LaunchContext], SomeEntitiesType | None]) -> None:
        self.__action = action
        self.__react = react
        super().__init__(matcher=self.__concerns)

    def __concerns(self, event: Event) -> bool:
        if isinstance(event, ProcessTargetedEvent):
            return isinstance(event, ShutdownProcess | SignalProcess) and event.process_matcher(self.__action)
        if isinstance(event, ProcessExited | ProcessStdin):
            return event.action is self.__action
        return isinstance(event, Shutdown)

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        super().handle(event, context)
        return self.__react(event, context)


class _LeftoverHandler(BaseEventHandler):
    """Event handler that stops, with the launch, what a process left running in its group."""

    def __init__(self, child: RunningProcess, timeouts: tuple[float, float]) -> None:
        super().__init__(matcher=lambda event: isinstance(event, Shutdown), handle_once=True)
        self.__child = child
        self.__timeouts = timeouts

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        super().handle(event, context)
        context.add_completion_future(context.running_loop.create_task(self.__end()))
        return None

    async def __end(self) -> None:
        await self.__child.end_group(timeouts=self.__timeouts, interrupted=False)
        self.__child.close()
