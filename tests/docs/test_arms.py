"""Every command of the page on industrial arms, typed, and what it prints compared with what the page says."""

from pathlib import Path

import pytest

from places import REPOSITORY

from . import pages

pytestmark = [pytest.mark.slow, pytest.mark.timeout(300)]


def test_page(tmp_path: Path, domain: int) -> None:
    pytest.importorskip("termios")
    from terminals import Terminal, environment

    from .reader import Reader

    reader = Reader(tmp_path, lambda folder: Terminal(environment(domain, tmp_path), folder))
    reader.follow(pages.read(REPOSITORY / "docs" / "arms.md"))
    reader.close()
    assert not reader.mismatches, "\n".join(["", *reader.mismatches])
