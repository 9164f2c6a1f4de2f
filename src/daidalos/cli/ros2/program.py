"""Program of the command `ros2`: parses, runs the command and returns the exit status."""

from __future__ import annotations

import os
import signal
import sys
import time
from types import FrameType

_INTERRUPTED = int(signal.SIGINT)
"""Exit status after Ctrl-C, as of ROS 2's own command."""

_BROKEN_PIPE = 141
_SAME_PRESS_S = 0.5
_IMPORT_SYSTEM = "<frozen importlib"


def run(argv: list[str]) -> int:
    """Run a command line; return the exit status."""
    try:
        try:
            status = _run(argv)
        finally:
            sys.stdout.flush()
    except KeyboardInterrupt:
        return _INTERRUPTED
    except BrokenPipeError:
        _discard_output()
        return _BROKEN_PIPE
    except Exception as error:
        if not _follows_interrupt(error):
            raise
        return _INTERRUPTED
    return status


def _follows_interrupt(error: BaseException) -> bool:
    """Return whether an exception occurred during the clean-up after Ctrl-C."""
    context = error.__context__
    return context is not None and (isinstance(context, KeyboardInterrupt) or _follows_interrupt(context))


def run_interruptible(argv: list[str]) -> int:
    """Run the command line of this process, and handle Ctrl-C from now on."""
    try:
        _handle_interrupts()
        return run(argv)
    except KeyboardInterrupt:
        return _INTERRUPTED
    finally:
        # During the interpreter's shutdown no code would catch the exception.
        signal.signal(signal.SIGINT, signal.SIG_DFL)


def _run(argv: list[str]) -> int:
    from ros2cli.parser import Parser

    from daidalos.cli.ros2.commands import commands
    from daidalos.cli.ros2.errors import CliError
    from daidalos.cli.ros2.extension import make_command
    from daidalos.common.errors import UserError
    from daidalos.common.extensions import ExtensionError
    from daidalos.distribution import complete_environment

    complete_environment()
    parser = Parser(prog="ros2", description="ros2 is an extensible command-line tool for ROS 2.")
    parser.add_argument(
        "--use-python-default-buffering",
        action="store_true",
        help="Do not force line buffering in stdout and instead use the python default buffering, which might be "
        "affected by PYTHONUNBUFFERED/-u and depends on whatever stdout is interactive or not",
    )
    parser.add_subcommands("Commands", "ros2", commands(), make_command)
    if "_ARGCOMPLETE" in os.environ:
        import argcomplete

        argcomplete.autocomplete(parser, always_complete_options=False, exclude=["-h", "--help"])
    try:
        args = parser.parse_args(argv)
    except ExtensionError as error:
        return _fail(f"ros2: {error}", 1)
    if not args.use_python_default_buffering and hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(line_buffering=True)
    if not hasattr(args, "_main"):
        parser.print_help()
        return 0
    try:
        args.words = argv  # for a command that is carried out by another process
        status = args._main(args)
    except CliError as error:
        return _fail(str(error), error.status)
    except UserError as error:
        return _fail(str(error), 1)
    except (RuntimeError, ValueError) as error:
        if isinstance(error, RecursionError | NotImplementedError) or _follows_interrupt(error):
            raise
        return _fail(str(error), 1)
    return _fail(status, 1) if isinstance(status, str) else status or 0


def _handle_interrupts() -> None:
    """Raise KeyboardInterrupt at Ctrl-C, and ignore repeated ones during the clean-up.

    A terminal, a shell and a program that watches over us may each send the signal for one press of the keys. Who
    presses them again after that means it: we die at once.
    """
    first: float | None = None

    def on_interrupt(number: int, frame: FrameType | None) -> None:
        nonlocal first
        # What is raised in the import system may be swallowed. While it works little is there to be tidied up.
        importing = frame is not None and frame.f_code.co_filename.startswith(_IMPORT_SYSTEM)
        if importing or (first is not None and time.monotonic() - first > _SAME_PRESS_S):
            signal.signal(number, signal.SIG_DFL)
            signal.raise_signal(number)
        elif first is None:
            first = time.monotonic()
            raise KeyboardInterrupt

    # A shell's script makes what it puts in the background ignore Ctrl-C, but ends it by `kill -INT`.
    signal.signal(signal.SIGINT, on_interrupt)


def _fail(message: str, status: int) -> int:
    sys.stdout.flush()
    if message:
        print(message, file=sys.stderr)
    return status


def _discard_output() -> None:
    """Redirect the output, so that the interpreter does not report a broken pipe at its end."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, sys.stdout.fileno())
