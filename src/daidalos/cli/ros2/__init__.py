"""The command `ros2`.

Ctrl-C may come while its modules are still being imported. Until they are, it has its quiet default (through the
built-in module, as ``signal`` itself takes a while to import).
"""

from __future__ import annotations

import _signal  # type: ignore[import-not-found]
import sys


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
    if _signal.getsignal(_signal.SIGINT) is _signal.default_int_handler:
        _signal.signal(_signal.SIGINT, _signal.SIG_DFL)
    from daidalos.cli.ros2.program import run_interruptible

    return run_interruptible(sys.argv[1:])
