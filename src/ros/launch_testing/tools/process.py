"""A launched process in the hands of a test."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from typing import Any

from launch import LaunchService
from launch.actions import EmitEvent, ExecuteProcess
from launch.events import matches_action
from launch.events.process import ProcessExited, ShutdownProcess
from launch.launch_description import LaunchDescription


class ProcessProxy:
    """Process of a launch, for tests.

    Parameters
    ----------
    process_action
        The action that runs it.
    proc_info, proc_output
        The active handlers that know of it.
    output_filter
        Applied to its output first.
    """

    def __init__(
        self,
        process_action: ExecuteProcess,
        proc_info: Any,
        proc_output: Any,
        *,
        output_filter: Callable[[str], str] | None = None,
    ) -> None:
        self._process_action = process_action
        self._proc_info = proc_info
        self._proc_output = proc_output
        self._output_filter = output_filter

    def wait_for_shutdown(self, timeout: float | None = None) -> bool:
        """Wait for its end, and return whether it came in time."""
        with self._proc_info.proc_event:
            return bool(self._proc_info.proc_event.wait_for(lambda: self.terminated, timeout))

    def wait_for_output(self, condition: Callable[[str], bool] | None = None, timeout: float | None = None) -> bool:
        """Wait for any output, or for some of which `condition` is true, and return whether it came in time."""
        is_enough = condition or bool
        with self._proc_output.io_event:
            return bool(self._proc_output.io_event.wait_for(lambda: is_enough(self.output), timeout))

    @property
    def target_process_action(self) -> ExecuteProcess:
        """The action that runs it."""
        return self._process_action

    @property
    def stderr(self) -> str:
        """What it printed to its standard error."""
        return self.__text(lambda piece: piece.from_stderr)

    @property
    def stdout(self) -> str:
        """What it printed to its standard output."""
        return self.__text(lambda piece: piece.from_stdout)

    @property
    def output(self) -> str:
        """All that it printed."""
        return self.__text(lambda piece: True)

    def __text(self, wanted: Callable[[Any], bool]) -> str:
        try:
            pieces = self._proc_output[self._process_action]
        except (KeyError, RuntimeError):
            return ""  # it has not been started yet
        text = "".join(piece.text.decode(errors="replace") for piece in pieces if wanted(piece))
        return text if self._output_filter is None else self._output_filter(text)

    @property
    def running(self) -> bool:
        """Whether it was started and has not ended."""
        return self.__last_event() is not None and not self.terminated

    @property
    def terminated(self) -> bool:
        """Whether it has ended."""
        return isinstance(self.__last_event(), ProcessExited)

    @property
    def exit_code(self) -> int | None:
        """Its exit code, None while it has none."""
        event = self.__last_event()
        return event.returncode if isinstance(event, ProcessExited) else None

    def __last_event(self) -> Any:
        try:
            return self._proc_info[self._process_action]
        except KeyError:
            return None


@contextlib.contextmanager
def launch_process(
    launch_service: LaunchService, process_action: ExecuteProcess, proc_info: Any, proc_output: Any, **kwargs: Any
) -> Iterator[ProcessProxy]:
    """Run a process in a running launch service, and stop it in the end.

    Parameters
    ----------
    launch_service
        The service, which runs in another thread.
    process_action
        The action.
    proc_info, proc_output
        The active handlers that know of the service's processes; those of a launch test know of all.
    **kwargs
        As for `ProcessProxy`.
    """
    launch_service.include_launch_description(LaunchDescription([process_action]))
    proxy = ProcessProxy(process_action, proc_info, proc_output, **kwargs)
    try:
        yield proxy
    finally:
        if not proxy.terminated:
            stop = ShutdownProcess(process_matcher=matches_action(process_action))
            launch_service.include_launch_description(LaunchDescription([EmitEvent(event=stop)]))
            proxy.wait_for_shutdown(timeout=30)
