"""Every command of the page on assistance, typed, and what it prints compared with what the page says."""

import zlib
from pathlib import Path

import pytest

from artnet_port import artnet_port
from places import REPOSITORY

from . import pages

pytestmark = [pytest.mark.slow, pytest.mark.timeout(300)]


def test_page(tmp_path: Path) -> None:
    pytest.importorskip("termios")
    from terminals import Terminal, environment

    from .reader import Reader

    domain = 1 + zlib.crc32(str(tmp_path).encode()) % 100
    reader = Reader(tmp_path, lambda folder: Terminal(environment(domain, tmp_path), folder))
    with artnet_port():
        reader.follow(pages.read(REPOSITORY / "docs" / "assistance.md"))
        reader.close()
    assert not reader.mismatches, "\n".join(["", *reader.mismatches])
