"""The programs of a lock-step run: the command, the recorder, and what ends them."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NoReturn

from launch import launch_service
from launch._process import start_processes_by

from daidalos.lockstep.commands import body_of
from daidalos.lockstep.launched import ProgramStarter
from daidalos.lockstep.options import Options
from daidalos.lockstep.programs import Program, change_folder
from daidalos.lockstep.run import Run
from daidalos.lockstep.scheduler import LockstepError
from daidalos.lockstep.standstill import long_waits


def start(run: Run, command: list[str], options: Options) -> Program:
    """Start a command, and with it the recorder of a bag.

    Parameters
    ----------
    run : Run
    command : list of str
        The command line.
    options : Options
        When the command's launch is shut down, or else the command interrupted, and what is recorded.

    Raises
    ------
    LockstepError
        When the command is not a program of this Python.
    """
    install(run)
    program = _program(run, command)
    if options.bag is not None:
        _start_recorder(run, program, options.bag, options.exclude)
    program.start()
    until_s = options.until_s
    if until_s is not None:
        run.scheduler.spawn(lambda: _end_at(run, program, until_s), run.programs[0], "--until")
    return program


def install(run: Run) -> None:
    """Make what would start processes start programs of a run, and the working folder one of each program."""
    start_processes_by(ProgramStarter(run.create))
    system: Any = os
    system.chdir = change_folder
    system.execve = system.execvpe = _replace_program
    system.execv = system.execvp = lambda path, argv: _replace_program(path, argv, os.environ)


class Child:
    """Program that another one starts beside itself, with methods of `subprocess.Popen`.

    Parameters
    ----------
    run : Run
    command : list of str
        The command line.
    on_output : callable
        Takes 1 or 2 and the bytes that it writes.

    Raises
    ------
    LockstepError
        When the command is not a program of this Python.
    """

    def __init__(self, run: Run, command: list[str], on_output: Callable[[int, bytes], object]) -> None:
        self._program = _program(run, command, on_output)
        self._ended = threading.Event()
        self._program.on_exit.append(lambda status: self._ended.set())
        self._program.start()

    def poll(self) -> int | None:
        """Return its exit status, None while it runs."""
        return self._program.status

    def send_signal(self, number: int) -> None:
        """Send it a signal."""
        self._program.send_signal(number)

    def wait(self) -> None:
        """Wait for its end."""
        self._ended.wait()


def _program(run: Run, command: list[str], on_output: Callable[[int, bytes], object] | None = None) -> Program:
    found = body_of(command, os.environ)
    if found is None:
        raise LockstepError(f"'{command[0]}' is not a program of this Python")
    argv, body = found
    return run.create(body, argv, on_output=on_output)


def _start_recorder(run: Run, program: Program, bag: str, exclude: str | None) -> None:
    """Record until the program ends; a recorder that fails ends the run."""
    errors = sys.stderr

    def show(fd: int, data: bytes) -> None:
        if fd == 2:
            errors.write(data.decode(errors="replace"))

    command = ["ros2", "bag", "record", "--all", "--log-level", "warn", "--output", bag]
    if exclude is not None:
        command += ["--exclude-regex", exclude]
    recorder = _program(run, command, show)

    def check(status: int) -> None:
        if program.status is None or status != 0:
            run.scheduler.stop(LockstepError(f"the recording to '{bag}' ended with status {status}"))

    recorder.on_exit.append(check)
    program.on_exit.append(lambda status: recorder.send_signal(signal.SIGINT))
    recorder.start()


def _end_at(run: Run, program: Program, until_s: float) -> None:
    run.scheduler.sleep_until(round(1e9 * until_s))
    if program.status is not None:
        return
    late = long_waits(run.scheduler.threads.values(), run.scheduler.now_ns)
    for line in (f"the run ends at {until_s:g} s", *late):
        sys.stderr.write(f"[lockstep] {line}\n")
    launches = launch_service.running_services()
    if launches:
        launches[0].shutdown()
    else:
        program.send_signal(signal.SIGINT)


def _replace_program(path: str, argv: Sequence[str], environ: Mapping[str, str]) -> NoReturn:
    """Go on with another command line in place of the present program."""
    found = body_of([path, *argv[1:]], environ)
    if found is None:
        raise OSError(f"in lock-step only programs of this Python run, not '{path}'")
    sys.argv, body = found
    if environ is not os.environ:
        os.environ.clear()
        os.environ.update(environ)
    sys.exit(body())
