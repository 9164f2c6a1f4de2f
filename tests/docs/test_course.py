"""Every command of the course's pages, typed, and what it prints compared with what the page says."""

import shutil

import pytest

from places import REPOSITORY

from . import pages

COURSE = REPOSITORY / "docs" / "course"
_LONGEST_S = 600

pytestmark = [pytest.mark.slow, pytest.mark.timeout(_LONGEST_S)]


@pytest.fixture
def follow(tmp_path, domain):
    """Follows pages, one after the other, in a home folder with an empty workspace."""
    pytest.importorskip("termios")
    from terminals import Terminal, environment

    from .reader import Reader

    readers = []

    def follow_pages(names):
        mismatches = []
        for name in names:
            page = pages.read(COURSE / name)
            if page.needs and not shutil.which(page.needs):
                pytest.skip(f"there is no {page.needs}")
            readers.append(Reader(tmp_path, lambda folder: Terminal(environment(domain, tmp_path), folder)))
            readers[-1].follow(page)
            mismatches += readers[-1].mismatches
            readers[-1].close()
        return mismatches

    (tmp_path / "ros2_ws" / "src").mkdir(parents=True)
    yield follow_pages
    for reader in readers:
        reader.close()


def sequences():
    """Return the course's pages, each with those that go on with its files."""
    found = {}
    for path in sorted(COURSE.glob("[0-9]*.md")):
        found.setdefault(pages.read(path).continues or path.name, []).append(path.name)
    return found.values()


@pytest.mark.parametrize("names", sequences(), ids=" ".join)
def test_page(names, follow):
    mismatches = follow(names)
    assert not mismatches, "\n".join(["", *mismatches])
