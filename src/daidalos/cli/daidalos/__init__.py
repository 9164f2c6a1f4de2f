"""The command `daidalos`.

Ctrl-C may come while its modules are still being imported. Until they are, it has its quiet default (through the
built-in module, as ``signal`` itself takes a while to import).
"""

from __future__ import annotations

import _signal  # type: ignore[import-not-found]


def main(argv: list[str] | None = None) -> int:
    """Run the command line; return the exit status, which is 130 after Ctrl-C.

    Parameters
    ----------
    argv
        The arguments. Those of the process where None: then Ctrl-C is handled, too.
    """
    is_process = argv is None and _signal.getsignal(_signal.SIGINT) is _signal.default_int_handler
    if is_process:
        _signal.signal(_signal.SIGINT, _signal.SIG_DFL)
    from daidalos.cli.daidalos.program import run

    if is_process:
        _signal.signal(_signal.SIGINT, _signal.default_int_handler)
    return run(argv)
