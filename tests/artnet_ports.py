"""The UDP port of Art-Net, which one receiver of a machine has at a time."""

import socket
from collections.abc import Iterator
from contextlib import contextmanager

import pytest
from filelock import FileLock

from daidalos.industry.lighting.artnet import PORT
from places import MACHINE_TEMPORARY


@contextmanager
def artnet_port() -> Iterator[None]:
    """Keep the port for one test at a time; skip where a program beside the tests has it."""
    with FileLock(MACHINE_TEMPORARY / "daidalos-tests-artnet.lock"):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            try:
                probe.bind(("127.0.0.1", PORT))
            except OSError:
                pytest.skip("another program receives Art-Net here")
        yield
