"""Error of commands."""

from __future__ import annotations


class CliError(Exception):
    """Mistake that the user can correct.

    Parameters
    ----------
    message
        Goes to standard error as it is; empty to say nothing.
    status
        The command's exit status.
    """

    def __init__(self, message: str = "", status: int = 1) -> None:
        super().__init__(message)
        self.status = status
