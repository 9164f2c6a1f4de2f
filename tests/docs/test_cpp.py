"""Every command of the page on C++, typed, and what it prints compared with what the page says."""

from pathlib import Path

import pytest

from places import REPOSITORY

from . import pages

pytestmark = [pytest.mark.slow, pytest.mark.timeout(400)]


def test_page(tmp_path: Path, domain: int) -> None:
    pytest.importorskip("termios")
    from cpp_packages import need_compiler, share_library
    from terminals import Terminal, environment

    from .reader import Reader

    need_compiler()
    share_library(tmp_path)
    reader = Reader(tmp_path, lambda folder: Terminal(environment(domain, tmp_path), folder))
    reader.follow(pages.read(REPOSITORY / "docs" / "cpp.md"))
    reader.close()
    assert not reader.mismatches, "\n".join(["", *reader.mismatches])
