"""Every command of the pages on welding and seam servoing, typed, and what it prints compared with the page."""

from pathlib import Path

import pytest

from places import REPOSITORY

from . import pages

pytestmark = [pytest.mark.slow, pytest.mark.timeout(300)]


@pytest.mark.parametrize("page", ["welding.md", "seam-servoing.md"])
def test_page(page: str, tmp_path: Path) -> None:
    pytest.importorskip("termios")
    from terminals import Terminal, environment

    from .reader import Reader

    reader = Reader(tmp_path, lambda folder: Terminal(environment(1, tmp_path), folder))
    reader.follow(pages.read(REPOSITORY / "docs" / page))
    reader.close()
    assert not reader.mismatches, "\n".join(["", *reader.mismatches])
