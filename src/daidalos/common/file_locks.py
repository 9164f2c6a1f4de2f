"""Locks between processes, which end with the process that holds them."""

from __future__ import annotations

import sys
from typing import IO


def lock_file(file: IO[bytes], *, wait: bool) -> None:
    """Lock an open file against other processes, and other openings of it, until it is closed.

    Raises
    ------
    OSError
        Somebody holds the lock, where ``wait`` is False.
    """
    if sys.platform == "win32":
        import msvcrt

        file.seek(0)
        msvcrt.locking(file.fileno(), msvcrt.LK_LOCK if wait else msvcrt.LK_NBLCK, 1)
    else:
        import fcntl

        fcntl.flock(file, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
