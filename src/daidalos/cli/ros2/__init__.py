"""The command `ros2`; until its modules are imported, Ctrl-C ends it without a word."""

from __future__ import annotations

import sys

from daidalos.cli.early_interrupts import DEFAULT, handle_early_interrupts


def main(argv: list[str] | None = None) -> int:
    """Run the command line; return the exit status.

    Parameters
    ----------
    argv
        The arguments. Those of the process where None: then Ctrl-C is handled, too.
    """
    if argv is not None:
        from daidalos.cli.ros2.program import run

        return run(argv)
    handle_early_interrupts(DEFAULT)
    from daidalos.cli.ros2.program import run_interruptible

    return run_interruptible(sys.argv[1:])
