"""The command `daidalos`; Ctrl-C while its modules are imported, or the interpreter shuts down, ends it at once."""

from __future__ import annotations

import os

from daidalos.cli.early_interrupts import handle_early_interrupts, raise_interrupts, set_interrupt_handler

_INTERRUPTED = 130


def main(argv: list[str] | None = None) -> int:
    """Run the command line; return the exit status, which is 130 after Ctrl-C.

    Parameters
    ----------
    argv
        The arguments. Those of the process where None: then Ctrl-C is handled, too.
    """
    is_process = argv is None and handle_early_interrupts(_exit)
    from daidalos.cli.daidalos.program import run

    if not is_process:
        return run(argv)
    try:
        raise_interrupts()
        return run(argv)
    except KeyboardInterrupt:  # before or after the program handles it
        return _INTERRUPTED
    finally:
        set_interrupt_handler(_exit)


def _exit(number: int, frame: object) -> None:
    os._exit(_INTERRUPTED)
