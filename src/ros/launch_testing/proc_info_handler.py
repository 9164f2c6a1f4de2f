"""Recorder of processes' exit codes for tests."""

from __future__ import annotations

import threading
from collections.abc import Iterable, Iterator
from types import UnionType

from launch.actions import ExecuteProcess
from launch.events.process import ProcessExited, ProcessStarted

from .util.proc_lookup import NoMatchingProcessException, process_details, resolveProcesses

ProcessInfo = ProcessStarted | ProcessExited


class ProcInfoHandler:
    """The last event of each process: that it was started, or that it ended."""

    def __init__(self) -> None:
        self._events: dict[ExecuteProcess, ProcessInfo] = {}

    def append(self, process_info: ProcessInfo) -> None:
        """Add an event."""
        self._events[process_info.action] = process_info

    def __iter__(self) -> Iterator[ProcessInfo]:
        return iter(list(self._events.values()))

    def processes(self) -> Iterable[ExecuteProcess]:
        """Return the actions of all known processes."""
        return list(self._events)

    def process_names(self) -> Iterable[str]:
        """Return the names of all known processes."""
        return [process_details(action)["name"] for action in self._events]

    def __getitem__(self, key: str | ExecuteProcess) -> ProcessInfo:
        """Return the last event of a process, given its name, a part of it, or its action."""
        if isinstance(key, str):
            for action, event in self._events.items():
                if key in process_details(action)["name"]:
                    return event
            raise KeyError(key)
        return self._events[key]


class ActiveProcInfoHandler:
    """A `ProcInfoHandler` that another thread fills, and that can be waited for."""

    def __init__(self) -> None:
        self._sync_lock = threading.Condition()
        self._proc_info_handler = ProcInfoHandler()

    @property
    def proc_event(self) -> threading.Condition:
        """Notified whenever there is something new."""
        return self._sync_lock

    def append(self, process_info: ProcessInfo) -> None:
        """Add an event."""
        with self._sync_lock:
            self._proc_info_handler.append(process_info)
            self._sync_lock.notify_all()

    def __iter__(self) -> Iterator[ProcessInfo]:
        with self._sync_lock:
            return iter(self._proc_info_handler)

    def processes(self) -> Iterable[ExecuteProcess]:
        """Return the actions of all known processes."""
        with self._sync_lock:
            return self._proc_info_handler.processes()

    def process_names(self) -> Iterable[str]:
        """Return the names of all known processes."""
        with self._sync_lock:
            return self._proc_info_handler.process_names()

    def __getitem__(self, key: str | ExecuteProcess) -> ProcessInfo:
        """Return the last event of a process, given its name, a part of it, or its action."""
        with self._sync_lock:
            return self._proc_info_handler[key]

    def assertWaitForShutdown(
        self, process: ExecuteProcess | str, cmd_args: str | None = None, *, timeout: float = 10
    ) -> None:
        """Wait for the end of a process.

        Parameters
        ----------
        process, cmd_args
            Which, as for `launch_testing.util.resolveProcesses`.
        timeout
            Seconds to wait at most.

        Raises
        ------
        AssertionError
            If it does not end in time.
        """
        success = self.__wait_for(ProcessExited, process, cmd_args, timeout)
        assert success, f"Timed out waiting for process '{process}' to finish"

    def assertWaitForStartup(
        self, process: ExecuteProcess | str, cmd_args: str | None = None, *, timeout: float = 10
    ) -> None:
        """Wait for the start of a process; parameters as for `assertWaitForShutdown`.

        Raises
        ------
        AssertionError
            If it is not started in time.
        """
        success = self.__wait_for(ProcessStarted | ProcessExited, process, cmd_args, timeout)
        assert success, f"Timed out waiting for process '{process}' to start"

    def __wait_for(
        self, kind: type | UnionType, process: ExecuteProcess | str, cmd_args: str | None, timeout: float
    ) -> bool:
        def happened() -> bool:
            try:
                found = resolveProcesses(self._proc_info_handler, process=process, cmd_args=cmd_args)
            except NoMatchingProcessException:
                return False
            return all(isinstance(self._proc_info_handler[action], kind) for action in found)

        with self._sync_lock:
            return self._sync_lock.wait_for(happened, timeout=timeout)
