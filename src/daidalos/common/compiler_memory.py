"""Memory of the compiler of kernels, which is not needed any more once they are compiled."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path

COMPILER = "libllvmlite"
"""What the name of the compiler's library contains."""

_MAPS = Path("/proc/self/smaps")
_AREA = re.compile(r"([0-9a-f]+)-([0-9a-f]+) (\S+) \S+ \S+ \S+\s*(.*)")
_MADV_DONTNEED = 4


def release_compiler_memory() -> int:
    """Give back the memory [bytes] that the code of the compiler takes, some 65 MB; return how much.

    Only pages that are as they are in the file are given back, so the system reads them again where a kernel is
    compiled later. Does nothing on other systems than Linux.
    """
    if sys.platform != "linux":
        return 0
    import ctypes

    libc = ctypes.CDLL(None)
    released = 0
    try:
        with _MAPS.open() as lines:
            for begin, end, resident in unchanged_areas(lines, COMPILER):
                if libc.madvise(ctypes.c_void_p(begin), ctypes.c_size_t(end - begin), _MADV_DONTNEED) == 0:
                    released += resident
    except OSError:  # a system without /proc
        return released
    return released


def unchanged_areas(lines: Iterable[str], name: str) -> Iterator[tuple[int, int, int]]:
    """Find the areas of memory that show a file and were never written to.

    Parameters
    ----------
    lines
        Those of ``/proc/PID/smaps``.
    name
        What the name of the file contains.

    Yields
    ------
    tuple of int
        First address, first address after it, and how much of it is in memory [bytes].
    """
    begin = end = resident = 0
    is_wanted = False
    for line in lines:
        area = _AREA.match(line)
        if area is not None:
            begin, end = int(area[1], 16), int(area[2], 16)
            is_wanted = name in area[4] and "w" not in area[3]
        elif is_wanted and line.startswith("Rss:"):
            resident = 1024 * int(line.split()[1])
        elif is_wanted and line.startswith("Anonymous:") and int(line.split()[1]) == 0:
            yield begin, end, resident
