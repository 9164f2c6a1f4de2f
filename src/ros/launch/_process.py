"""A child process in a process group of its own, whose output arrives in the event loop.

A group of its own keeps a terminal's Ctrl-C from reaching the child directly, so that the launch decides in
which order processes stop, and it lets one signal reach the child together with what it started itself.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import struct
import sys
import types
from collections.abc import Callable, Coroutine, Generator
from contextlib import AbstractContextManager
from typing import Any, Protocol

from daidalos.workspaces.executables import interrupts_blocked, reporting_command
from daidalos.workspaces.orphans import guard

from ._programs import search_path, which

_POSIX = os.name == "posix"
_CHUNK = 1 << 16
# A pipe holds at most 1 MiB, so this empties any.
_CHUNKS_LEFT_AT_EXIT = 16
_POLL_INTERVAL = 0.02
_ORPHANS_TIMEOUT = 0.5

OnOutput = Callable[[int, bytes], None]


class RunningProcess(Protocol):
    """What a launch asks of a process that it started: the interface of `ChildProcess`."""

    @property
    def pid(self) -> int:
        """The number of the process."""

    @property
    def running(self) -> bool:
        """Whether it has not ended yet."""

    @property
    def has_leftovers(self) -> bool:
        """Whether it has ended and something that it started goes on."""

    async def wait(self) -> int:
        """Wait until it has ended; return its exit code."""

    def write(self, data: bytes) -> None:
        """Write to its standard input."""

    def send_signal(self, signum: int, *, to_group: bool) -> None:
        """Send a signal to it, or to it and all that it started."""

    async def end_group(self, *, timeouts: tuple[float, float], interrupted: bool) -> None:
        """Stop what it left running."""

    def close(self) -> None:
        """Release what belongs to it."""


class ProcessStarter(Protocol):
    """Function that starts a command line; `start_child` says what its arguments are and what it raises."""

    async def __call__(
        self,
        cmd: list[str],
        *,
        cwd: str | None,
        env: dict[str, str],
        shell: bool,
        emulate_tty: bool,
        on_output: OnOutput,
    ) -> RunningProcess:
        """Start it."""


def start_processes_by(starter: ProcessStarter) -> None:
    """Start the processes of all launches from now on by another function than `start_child`.

    It is for who runs programs as parts of one process, as `daidalos.lockstep` does.
    """
    global _starter
    _starter = starter


def process_starter() -> ProcessStarter:
    """Return the function that starts the processes of launches."""
    return _starter


class ChildProcess(asyncio.SubprocessProtocol):
    """A running child; make one with `start_child`.

    Parameters
    ----------
    on_output
        Called in the event loop with 1 (output) or 2 (errors) and the bytes.
    """

    def __init__(self, on_output: OnOutput) -> None:
        self._on_output = on_output
        self._transport: Any = None
        self._streams: list[_Stream] = []
        self._exited: asyncio.Future[int] = asyncio.get_running_loop().create_future()

    @property
    def pid(self) -> int:
        """The process id, which is also the id of its process group."""
        pid: int = self._transport.get_pid()
        return pid

    @property
    def running(self) -> bool:
        """Whether the child has not ended yet."""
        return not self._exited.done()

    async def wait(self) -> int:
        """Wait until the child has ended and its output was read; return its exit code."""
        return await asyncio.shield(self._exited)

    def write(self, data: bytes) -> None:
        """Write to the child's standard input."""
        self._transport.get_pipe_transport(0).write(data)

    def send_signal(self, signum: int, *, to_group: bool) -> None:
        """Send a signal to the child, or to its whole group; one that is gone gets nothing."""
        with contextlib.suppress(ProcessLookupError, PermissionError):
            if not _POSIX:
                self._send_signal_on_windows(signum)
            elif to_group and signum == signal.SIGKILL:
                self._kill_tree()
            elif to_group:
                os.killpg(self.pid, signum)
            elif self.running:
                os.kill(self.pid, signum)

    def _kill_tree(self) -> None:
        # What a killed child started in other groups would be left without anybody to stop it.
        descendants = _descendants(self.pid) if self.running else []
        os.killpg(self.pid, signal.SIGKILL)
        for descendant in descendants:
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.kill(descendant.pid, signal.SIGKILL)

    def _send_signal_on_windows(self, signum: int) -> None:
        # Windows has no signals between processes; every request to stop ends the child and what it started.
        for descendant in _descendants(self.pid):
            descendant.kill()
        if self.running:
            self._transport.terminate()

    async def end_group(self, *, timeouts: tuple[float, float], interrupted: bool) -> None:
        """Stop what the child, which has ended itself, left running in its group.

        Parameters
        ----------
        timeouts
            Seconds to wait at most after SIGINT and after SIGTERM, before the next harder signal.
        interrupted
            Whether the group got its SIGINT already.
        """
        if not _POSIX or not _group_exists(self.pid):
            return
        # Nobody is there any more to stop it in some order of its own.
        first = min(timeouts[0], _ORPHANS_TIMEOUT)
        for signum, seconds in (
            (signal.SIGINT, first),
            (signal.SIGTERM, timeouts[1]),
            (signal.SIGKILL, 1.0),
        ):
            if not (signum == signal.SIGINT and interrupted):
                with contextlib.suppress(ProcessLookupError, PermissionError):
                    os.killpg(self.pid, signum)
            deadline = asyncio.get_running_loop().time() + seconds
            while _running_members(self.pid):
                if asyncio.get_running_loop().time() >= deadline:
                    break
                await asyncio.sleep(_POLL_INTERVAL)
            else:
                return

    @property
    def has_leftovers(self) -> bool:
        """Whether the child has ended and something in its group goes on."""
        return _POSIX and not self.running and _group_exists(self.pid) and bool(_running_members(self.pid))

    def close(self) -> None:
        """Close the pipes."""
        for stream in self._streams:
            stream.close()
        self._transport.close()
        guard.release(-self.pid)

    # Called by asyncio ----------------------------------------------------------------------------

    def connection_made(self, transport: Any) -> None:
        """Store the transport."""
        self._transport = transport

    def pipe_data_received(self, fd: int, data: bytes) -> None:
        """Process output that asyncio itself reads."""
        self._on_output(fd, data)

    def pipe_connection_lost(self, fd: int, exc: Exception | None) -> None:
        """Ignore that the child closed a stream; its end is what counts."""

    def process_exited(self) -> None:
        """Read what is left of the output and let `wait` return."""
        for stream in self._streams:
            stream.drain()
        if _POSIX:
            self._finish()

    def connection_lost(self, exc: Exception | None) -> None:
        """Complete `wait`, where asyncio itself reads the output to its end."""
        self._finish()

    def _finish(self) -> None:
        if not self._exited.done():
            self._exited.set_result(self._transport.get_returncode())


async def start_child(
    cmd: list[str],
    *,
    cwd: str | None,
    env: dict[str, str],
    shell: bool,
    emulate_tty: bool,
    on_output: OnOutput,
) -> ChildProcess:
    """Start a child process.

    Parameters
    ----------
    cmd
        The command line.
    cwd
        The working directory, None for the present one.
    env
        The environment.
    shell
        Whether a shell runs the command line.
    emulate_tty
        Whether the child writes to pseudo terminals instead of pipes.
    on_output
        Called in the event loop with 1 (output) or 2 (errors) and the bytes.

    Raises
    ------
    OSError
        If it cannot be started.
    """
    if cwd is not None and not os.path.isdir(cwd):
        raise NotADirectoryError(f"the working directory '{cwd}' does not exist")
    # A program that waits for another one of the launch can tell by the number whether the launch is still alive.
    env = {**env, "PATH": search_path(env), "DAIDALOS_LAUNCH_PID": str(os.getpid())}
    child = ChildProcess(on_output)
    options: dict[str, Any] = {"cwd": cwd, "env": env, "stdin": asyncio.subprocess.PIPE}
    if not _POSIX:
        options.update(stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE)
        await _spawn(child, cmd, shell, options)
        return child
    output, errors = _open_channel(emulate_tty), _open_channel(emulate_tty)
    try:
        await _spawn(child, cmd, shell, {**options, "stdout": output[1], "stderr": errors[1], "process_group": 0})
    except BaseException:
        os.close(output[0])
        os.close(errors[0])
        raise
    finally:
        os.close(output[1])
        os.close(errors[1])
    guard.watch(-child.pid)
    child._streams = [_Stream(1, output[0], on_output), _Stream(2, errors[0], on_output)]
    return child


_starter: ProcessStarter = start_child


async def _spawn(child: ChildProcess, cmd: list[str], shell: bool, options: dict[str, Any]) -> None:
    loop = asyncio.get_running_loop()
    if shell:
        await loop.subprocess_shell(lambda: child, " ".join(cmd), **options)
        return
    program = cmd[0]
    if not os.path.dirname(program):
        found = which(program, options["env"])
        if found is None:
            raise FileNotFoundError(f"executable '{program}' not found on the PATH")
        program = found
    starting = loop.subprocess_exec(lambda: child, *reporting_command([program, *cmd[1:]]), **options)
    await _first_step_in(interrupts_blocked(cmd), starting)


@types.coroutine
def _first_step_in(
    context: AbstractContextManager[None], starting: Coroutine[Any, Any, Any]
) -> Generator[Any, Any, Any]:
    """Await a coroutine, whose first step, which creates the process, runs within a context.

    While the rest waits for the process's pipes, the loop makes other processes, which would inherit a signal that is
    still blocked.
    """
    steps = starting.__await__()
    with context:
        awaited = next(steps)
    try:
        yield awaited
    except BaseException as error:  # it is for the coroutine, as in an await
        yield steps.throw(error)
    yield from steps


def _open_channel(emulate_tty: bool) -> tuple[int, int]:
    """Return the ends of a pipe or of a pseudo terminal to read from and to write to."""
    if not emulate_tty:
        return os.pipe()
    import fcntl
    import termios

    master, slave = os.openpty()
    attributes = termios.tcgetattr(slave)
    # Lines should end as the child writes them, not with an added carriage return.
    attributes[1] &= ~termios.OPOST
    termios.tcsetattr(slave, termios.TCSANOW, attributes)
    columns, rows = 80, 24
    with contextlib.suppress(OSError, ValueError, AttributeError):
        columns, rows = os.get_terminal_size(sys.stdout.fileno())
    fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
    return master, slave


class _Stream:
    """The end of a pipe or pseudo terminal to which a child writes."""

    def __init__(self, number: int, fd: int, on_output: OnOutput) -> None:
        self.number = number
        self.fd = fd
        self.on_output = on_output
        self.loop = asyncio.get_running_loop()
        os.set_blocking(fd, False)
        self.loop.add_reader(fd, self.read)

    def read(self) -> bool:
        """Read a piece if there is one."""
        if self.fd < 0:
            return False
        try:
            data = os.read(self.fd, _CHUNK)
        except BlockingIOError:
            return False
        except OSError:
            # A pseudo terminal ends with an error.
            data = b""
        if not data:
            self.close()
            return False
        self.on_output(self.number, data)
        return True

    def drain(self) -> None:
        """Read all that is there."""
        for _ in range(_CHUNKS_LEFT_AT_EXIT):
            if not self.read():
                break

    def close(self) -> None:
        if self.fd >= 0:
            self.loop.remove_reader(self.fd)
            os.close(self.fd)
            self.fd = -1


def _group_exists(group: int) -> bool:
    try:
        os.killpg(group, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True


def _running_members(group: int) -> list[Any]:
    """Return the processes of a group that are not just waiting to be forgotten."""
    import psutil

    members = []
    for process in psutil.process_iter():
        with contextlib.suppress(psutil.Error, ProcessLookupError):
            if os.getpgid(process.pid) == group and process.status() != psutil.STATUS_ZOMBIE:
                members.append(process)
    return members


def _descendants(pid: int) -> list[Any]:
    import psutil

    try:
        return psutil.Process(pid).children(recursive=True)
    except psutil.Error:
        return []
