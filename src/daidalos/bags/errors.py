"""Error of bags."""

from __future__ import annotations

from pathlib import Path


class BagError(RuntimeError):
    """A bag that cannot be read or written.

    Parameters
    ----------
    path
        The bag, or the file of it that is at fault.
    reason
        What is wrong, and what was expected.
    """

    def __init__(self, path: str | Path, reason: str) -> None:
        super().__init__(f"{path}: {reason}")
        self.path = Path(path)
        self.reason = reason
