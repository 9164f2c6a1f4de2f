"""ROS domains that no other test of any run on this machine has at the same time."""

import itertools
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import IO

import pytest

from places import MACHINE_TEMPORARY

_numbers = itertools.count(os.getpid())


@contextmanager
def reserved_domain() -> Iterator[int]:
    """Yield the number of a domain that is nobody else's meanwhile."""
    folder = MACHINE_TEMPORARY / "daidalos-test-domains"
    folder.mkdir(exist_ok=True)
    for number in (100 + next(_numbers) % 100 for _ in range(100)):
        with (folder / str(number)).open("a") as file:
            if _is_reserved(file):
                yield number
                return
    pytest.fail("all of a hundred domains are taken")


def _is_reserved(file: IO[str]) -> bool:
    """Lock a file until it is closed; tell whether nobody else had."""
    try:
        if sys.platform == "win32":
            import msvcrt

            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
        else:
            import fcntl

            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True
