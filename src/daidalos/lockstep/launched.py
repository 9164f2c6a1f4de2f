"""Processes of a launch as programs of a lock-step run."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from daidalos.lockstep.commands import body_of
from daidalos.lockstep.programs import Program


class LaunchedProgram:
    """A program with the interface that a launch expects of a child process.

    Parameters
    ----------
    program : Program
    number : int
        That stands for a process id.
    """

    def __init__(self, program: Program, number: int) -> None:
        loop = asyncio.get_running_loop()
        self.pid = number
        self._program = program
        self._exited: asyncio.Future[int] = loop.create_future()

        def finish(status: int) -> None:
            loop.call_soon_threadsafe(self._exited.set_result, status)

        program.on_exit.append(finish)

    @property
    def running(self) -> bool:
        """Whether the program has not ended yet."""
        return not self._exited.done()

    async def wait(self) -> int:
        """Wait until the program has ended; return its exit status."""
        return await asyncio.shield(self._exited)

    def write(self, data: bytes) -> None:
        """Discard what would be its standard input."""

    def send_signal(self, signum: int, *, to_group: bool) -> None:
        """Send a signal to the program."""
        self._program.send_signal(signum)

    async def end_group(self, *, timeouts: tuple[float, float], interrupted: bool) -> None:
        """Return; a program leaves nothing running."""

    @property
    def has_leftovers(self) -> bool:
        """Whether the program left something running."""
        return False

    def close(self) -> None:
        """Return; there is nothing to close."""


class ProgramStarter:
    """Starter of a launch's processes, for `launch._process.start_processes_by`.

    Parameters
    ----------
    create : callable
        Takes body, arguments, environment, working folder and where its output goes; returns a program.
    """

    def __init__(self, create: Callable[..., Program]) -> None:
        self._create = create
        self._number = 1000

    async def __call__(
        self,
        cmd: Sequence[str],
        *,
        cwd: str | None,
        env: Mapping[str, str] | None,
        shell: bool,
        emulate_tty: bool,
        on_output: Callable[[int, bytes], None],
    ) -> Any:
        """Start a command line; raise OSError when it is not a program of this Python."""
        environ = dict(os.environ if env is None else env)
        found = None if shell else body_of(cmd, environ)
        if found is None:
            raise OSError("in lock-step only programs of this Python run")
        argv, body = found
        loop = asyncio.get_running_loop()
        program = self._create(
            body,
            argv,
            environ=environ,
            folder=cwd,
            on_output=lambda fd, data: loop.call_soon_threadsafe(on_output, fd, data),
        )
        self._number += 1
        launched = LaunchedProgram(program, self._number)
        program.start()
        return launched
