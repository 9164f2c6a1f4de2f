"""Every command of the course's pages, typed, and what it prints compared with what the page says."""

import shutil
import zlib

import pytest

from places import REPOSITORY

from . import pages

COURSE = REPOSITORY / "docs" / "course"
_LONGEST_S = 600

pytestmark = [pytest.mark.slow, pytest.mark.timeout(_LONGEST_S)]


@pytest.fixture
def follow(tmp_path):
    """Follows a page in a home folder with an empty workspace."""
    pytest.importorskip("termios")
    from terminals import Terminal, environment

    from .reader import Reader

    readers = []

    def follow_page(name):
        page = pages.read(COURSE / name)
        if page.needs and not shutil.which(page.needs):
            pytest.skip(f"there is no {page.needs}")
        domain = 1 + zlib.crc32(str(tmp_path).encode()) % 100
        readers.append(Reader(tmp_path, lambda folder: Terminal(environment(domain, tmp_path), folder)))
        readers[-1].follow(page)
        mismatches = readers[-1].mismatches
        readers[-1].close()
        return mismatches

    (tmp_path / "ros2_ws" / "src").mkdir(parents=True)
    yield follow_page
    for reader in readers:
        reader.close()


@pytest.mark.parametrize("name", sorted(path.name for path in COURSE.glob("[0-9]*.md")))
def test_page(name, follow):
    mismatches = follow(name)
    assert not mismatches, "\n".join(["", *mismatches])
