"""Reuse of the memory of large messages."""

from __future__ import annotations

import ctypes
import os
import sys

_TRIM_THRESHOLD, _MMAP_THRESHOLD = -1, -3
"""Parameters of the GNU C library's ``mallopt``."""
_KEPT = 64 * 2**20
_MAX_KEPT = 32 * 2**20
"""Maximum value that the library accepts."""


def keep_memory() -> None:
    """Configure the C library to keep up to 64 MB of freed memory.

    It gives blocks of the size of an image back to the system and asks for them again with every message, and the
    system clears every page of them: more work than all the rest of sending an image. Where the user tells the
    library what to do, or it is another one, nothing changes.
    """
    told = any(name.startswith("MALLOC_") for name in os.environ) or "malloc" in os.environ.get("GLIBC_TUNABLES", "")
    if sys.platform != "linux" or told:
        return
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    if mallopt is not None:
        mallopt(_TRIM_THRESHOLD, _KEPT)
        mallopt(_MMAP_THRESHOLD, _MAX_KEPT)
