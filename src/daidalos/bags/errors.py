"""Error of bags."""

from __future__ import annotations

from pathlib import Path

from daidalos.common.errors import Location, UserError


class BagError(UserError, RuntimeError):
    """A bag that cannot be read or written.

    Parameters
    ----------
    path
        The bag, or the file of it that is at fault.
    reason
        What is wrong, and what was expected.
    """

    def __init__(self, path: str | Path, reason: str) -> None:
        super().__init__(reason, Location(str(path)))
        self.path = Path(path)
        self.reason = reason
