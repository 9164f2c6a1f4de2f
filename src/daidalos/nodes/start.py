"""Program of all built-in executables: ``python -S -P start.py PACKAGE MODULE ARGUMENT...``.

Ctrl-C reaches all processes of a terminal, also those that are still importing, where Python would answer with a
traceback. So whoever starts us blocks the signal (see `executables.interrupts_blocked`), and here it gets its quiet
default (through the built-in module, as ``signal`` itself takes a while to import) before it is let in, and before
``site``, which ``-S`` keeps back. `rclpy.init` takes the signal over later.
"""

from __future__ import annotations

import _signal  # type: ignore[import-not-found]
import sys

TYPE_CHECKING = False
if TYPE_CHECKING:
    from types import ModuleType, TracebackType
    from typing import NoReturn

if __name__ == "__main__":
    _signal.signal(_signal.SIGINT, _signal.SIG_DFL)
    if hasattr(_signal, "pthread_sigmask"):
        _signal.pthread_sigmask(_signal.SIG_UNBLOCK, [_signal.SIGINT])


MISTAKES = {
    "EnvironmentVariableError",
    "InvalidParameterTypeException",
    "InvalidParameterValueException",
    "RCLInvalidROSArgsError",
    "UnknownROSArgsError",
}
"""Errors that the user can correct; their messages say how."""


def main() -> None:
    """Run the module of a package that the arguments name."""
    import site

    site.main()
    sys.excepthook = show
    package, module, *arguments = sys.argv[1:]
    _end(run_module(package, module, arguments))


def run_module(package: str, module: str, arguments: list[str]) -> int:
    """Run a module of a package: its function `main`, which returns the exit status, or else the node of its name."""
    from importlib import import_module

    program = import_module(f"daidalos.nodes.{package}.{module}")
    sys.argv = [str(program.__file__), *arguments]
    status: int = program.main() if hasattr(program, "main") else _run_node(program, module)
    return status


def _end(status: int) -> NoReturn:
    """End the process as `sys.exit` does, but let the system free its memory.

    Python would free each object of each module, which takes a second where a whole robot runs in the process.
    """
    import atexit
    import os
    import threading
    from contextlib import suppress

    threading._shutdown()  # type: ignore[attr-defined]
    atexit._run_exitfuncs()
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError, ValueError):  # it may be closed
            stream.flush()
    os._exit(status or 0)


def _run_node(program: ModuleType, module: str) -> int:
    """Run the node of a module that has no `main`: ``MapServer`` of ``map_server``."""
    from daidalos.common.names import camel_case
    from daidalos.nodes.runner import run

    return run(getattr(program, camel_case(module)))


def show(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
    """Print an error that the user can correct in one line; any other as Python does."""
    if kind.__name__ in MISTAKES:
        print(error, file=sys.stderr)
    else:
        sys.__excepthook__(kind, error, trace)


if __name__ == "__main__":
    main()
