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
    from types import TracebackType

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
    """Run the function `main` of a module of a package; it returns the exit status."""
    import site
    from importlib import import_module

    site.main()
    sys.excepthook = _show
    package, module, *arguments = sys.argv[1:]
    program = import_module(f"daidalos.nodes.{package}.{module}")
    sys.argv = [str(program.__file__), *arguments]
    sys.exit(program.main())


def _show(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
    if kind.__name__ in MISTAKES:
        print(error, file=sys.stderr)
    else:
        sys.__excepthook__(kind, error, trace)


if __name__ == "__main__":
    main()
