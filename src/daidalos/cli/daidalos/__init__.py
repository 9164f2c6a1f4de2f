"""The command `daidalos`.

Ctrl-C may come while its modules are still being imported, or while the interpreter shuts down. At these times it ends
the process at once, with the status that it has at any other (the handler is set through the built-in module, as
``signal`` itself takes a while to import).
"""

from __future__ import annotations

import _signal  # type: ignore[import-not-found]
import os

_INTERRUPTED = 130


def main(argv: list[str] | None = None) -> int:
    """Run the command line; return the exit status, which is 130 after Ctrl-C.

    Parameters
    ----------
    argv
        The arguments. Those of the process where None: then Ctrl-C is handled, too.
    """
    is_process = argv is None and _signal.getsignal(_signal.SIGINT) is _signal.default_int_handler
    if is_process:
        _signal.signal(_signal.SIGINT, _exit)
    from daidalos.cli.daidalos.program import run

    if not is_process:
        return run(argv)
    try:
        _signal.signal(_signal.SIGINT, _signal.default_int_handler)
        return run(argv)
    except KeyboardInterrupt:  # before or after the program handles it
        return _INTERRUPTED
    finally:
        _signal.signal(_signal.SIGINT, _exit)


def _exit(number: int, frame: object) -> None:
    os._exit(_INTERRUPTED)
