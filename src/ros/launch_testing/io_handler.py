"""Recorder of processes' output for tests."""

from __future__ import annotations

import threading
from collections.abc import Iterable, Iterator
from typing import Any

from launch.actions import ExecuteProcess
from launch.events.process import ProcessIO

from .asserts.assert_output import assertInStream
from .util.proc_lookup import NoMatchingProcessException, process_details


class IoHandler:
    """The pieces of output of all processes, in the order in which they came."""

    def __init__(self) -> None:
        self._sequence: list[ProcessIO] = []
        self._by_name: dict[str, list[ProcessIO]] = {}
        self._by_action: dict[ExecuteProcess, list[ProcessIO]] = {}

    def track(self, process_name: str) -> None:
        """Register a process, which may never print anything."""
        self._by_name.setdefault(process_name, [])

    def append(self, process_io: ProcessIO) -> None:
        """Add a piece of output."""
        self._sequence.append(process_io)
        self._by_name.setdefault(process_io.process_name, []).append(process_io)
        self._by_action.setdefault(process_io.action, []).append(process_io)

    def __iter__(self) -> Iterator[ProcessIO]:
        return iter(list(self._sequence))

    def processes(self) -> Iterable[ExecuteProcess]:
        """Return the actions whose processes printed something."""
        return list(self._by_action)

    def process_names(self) -> Iterable[str]:
        """Return the names of all known processes."""
        return list(self._by_name)

    def __getitem__(self, key: str | ExecuteProcess) -> list[ProcessIO]:
        """Return the output of a process, given its name or action."""
        if isinstance(key, str):
            return list(self._by_name[key])
        if key in self._by_action:
            return list(self._by_action[key])
        return list(self._by_name[process_details(key)["name"]])


class ActiveIoHandler:
    """An `IoHandler` that another thread fills, and that can be waited for."""

    def __init__(self) -> None:
        self._sync_lock = threading.Condition()
        self._io_handler = IoHandler()

    @property
    def io_event(self) -> threading.Condition:
        """Notified whenever there is something new."""
        return self._sync_lock

    def track(self, process_name: str) -> None:
        """Register a process, which may never print anything."""
        with self._sync_lock:
            self._io_handler.track(process_name)
            self._sync_lock.notify_all()

    def append(self, process_io: ProcessIO) -> None:
        """Add a piece of output."""
        with self._sync_lock:
            self._io_handler.append(process_io)
            self._sync_lock.notify_all()

    def __iter__(self) -> Iterator[ProcessIO]:
        with self._sync_lock:
            return iter(self._io_handler)

    def processes(self) -> Iterable[ExecuteProcess]:
        """Return the actions whose processes printed something."""
        with self._sync_lock:
            return self._io_handler.processes()

    def process_names(self) -> Iterable[str]:
        """Return the names of all known processes."""
        with self._sync_lock:
            return self._io_handler.process_names()

    def __getitem__(self, key: str | ExecuteProcess) -> list[ProcessIO]:
        """Return the output of a process, given its name or action."""
        with self._sync_lock:
            return self._io_handler[key]

    def assertWaitFor(self, *args: Any, **kwargs: Any) -> None:
        """Wait for some output; parameters as for `waitFor`.

        Raises
        ------
        AssertionError
            If it does not come in time.
        """
        success = self.waitFor(*args, **kwargs)
        assert success, f"Waiting for output timed out: {args} {kwargs}"

    def waitFor(
        self,
        expected_output: Any,
        process: ExecuteProcess | str | None = None,
        cmd_args: str | None = None,
        *,
        strict_proc_matching: bool = True,
        output_filter: Any = None,
        timeout: float = 10,
        strip_ansi_escape_sequences: bool = True,
        stream: str = "stderr",
    ) -> bool:
        """Wait for some output and return whether it came.

        Parameters
        ----------
        timeout
            Seconds to wait at most.
        expected_output, process, cmd_args, strict_proc_matching, output_filter, \
strip_ansi_escape_sequences, stream
            As for `launch_testing.asserts.assertInStream`.
        """

        def is_there() -> bool:
            try:
                assertInStream(
                    self._io_handler,
                    expected_output,
                    process,
                    cmd_args,
                    output_filter=output_filter,
                    strict_proc_matching=strict_proc_matching,
                    strip_ansi_escape_sequences=strip_ansi_escape_sequences,
                    stream=stream,
                )
            except (AssertionError, NoMatchingProcessException):
                return False
            return True

        with self._sync_lock:
            return self._sync_lock.wait_for(is_there, timeout=timeout)
