"""What is kept of the memory of large messages."""

from __future__ import annotations

import ctypes
import multiprocessing
import sys
from concurrent.futures import ProcessPoolExecutor

import pytest

from daidalos.transport.memory import keep_memory

ROUNDS = 20
IMAGE = bytes(921_600)


def pages_cleared_an_image() -> float:
    """Copy an image as a receiver does, again and again; return how many pages the system had to clear for each."""
    import resource

    keep_memory()
    before = 0
    for number in range(2 * ROUNDS):
        if number == ROUNDS:
            before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
        copies = [bytearray(IMAGE) for _ in range(3)]
        copies.clear()
    return (resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before) / ROUNDS


@pytest.mark.slow
@pytest.mark.skipif(
    not sys.platform.startswith("linux") or not hasattr(ctypes.CDLL(None), "mallopt"), reason="needs the GNU C library"
)
@pytest.mark.parametrize("told", [False, True])
def test_memory_is_kept_unless_the_user_says_otherwise(monkeypatch: pytest.MonkeyPatch, told: bool):
    for name in ("MALLOC_TRIM_THRESHOLD_", "GLIBC_TUNABLES"):
        monkeypatch.delenv(name, raising=False)
    if told:
        monkeypatch.setenv("MALLOC_TRIM_THRESHOLD_", "131072")
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as fresh:
        cleared = fresh.submit(pages_cleared_an_image).result(60)
    assert (cleared > 200) is told
