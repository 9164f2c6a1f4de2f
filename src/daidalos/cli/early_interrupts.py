"""Ctrl-C while the modules of a command are still being imported."""

from __future__ import annotations

import _signal  # type: ignore[import-not-found]

DEFAULT = _signal.SIG_DFL
"""Ends the process at once, as a process that the signal has ended."""


def handle_early_interrupts(handler: object) -> bool:
    """Set what Ctrl-C does until the command's own code handles it.

    It is set through the built-in module, as ``signal`` itself takes a while to import.

    Parameters
    ----------
    handler
        A function of the signal's number and the frame, or `DEFAULT`.

    Returns
    -------
    bool
        False where something else than Python's default handles Ctrl-C, which is then left as it is.
    """
    if _signal.getsignal(_signal.SIGINT) is not _signal.default_int_handler:
        return False
    _signal.signal(_signal.SIGINT, handler)
    return True


def set_interrupt_handler(handler: object) -> None:
    """Set what Ctrl-C does from now on."""
    _signal.signal(_signal.SIGINT, handler)


def raise_interrupts() -> None:
    """Make Ctrl-C raise KeyboardInterrupt, as Python does by default."""
    _signal.signal(_signal.SIGINT, _signal.default_int_handler)
