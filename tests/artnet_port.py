"""The UDP port of Art-Net, which one test of this machine at a time may use."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from filelock import FileLock

from places import MACHINE_TEMPORARY


@contextmanager
def artnet_port() -> Iterator[None]:
    """Keep the port for the length of a block; wait for it first."""
    with FileLock(MACHINE_TEMPORARY / "daidalos-tests-artnet.lock"):
        yield
