"""Files under a prefix: linked, copied, replaced and removed."""

import os
import sys

import pytest

from daidalos.workspaces.installation import Installation

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="links and permissions of other systems")


@pytest.fixture
def begin(tmp_path):
    def new(symlink):
        return Installation(tmp_path / "prefix", tmp_path / "build" / "record.txt", symlink)

    (tmp_path / "file.txt").write_text("text")
    return new


def test_links_show_what_the_source_has(begin, tmp_path):
    one = begin(True)
    one.put(tmp_path / "file.txt", "share/pkg/file.txt")
    (tmp_path / "file.txt").write_text("changed")
    assert (tmp_path / "prefix/share/pkg/file.txt").read_text() == "changed"


def test_copies_do_not(begin, tmp_path):
    one = begin(False)
    one.put(tmp_path / "file.txt", "share/pkg/file.txt")
    (tmp_path / "file.txt").write_text("changed")
    assert (tmp_path / "prefix/share/pkg/file.txt").read_text() == "text"


@pytest.mark.parametrize("first", [True, False])
def test_one_replaces_the_other_and_leaves_the_source_alone(begin, tmp_path, first):
    for symlink in (first, not first):
        one = begin(symlink)
        one.put(tmp_path / "file.txt", "share/file.txt")
        one.finish()
        assert (tmp_path / "prefix/share/file.txt").is_symlink() == symlink
    assert (tmp_path / "file.txt").read_text() == "text"


def test_programs_become_executable_but_not_their_source(begin, tmp_path):
    one = begin(True)
    one.put(tmp_path / "file.txt", "lib/pkg/file", executable=True)
    assert os.access(tmp_path / "prefix/lib/pkg/file", os.X_OK)
    assert not os.access(tmp_path / "file.txt", os.X_OK)


def test_what_a_later_build_has_no_more_is_removed_with_empty_folders(begin, tmp_path):
    one = begin(True)
    one.put(tmp_path / "file.txt", "share/pkg/launch/a")
    one.write("share/pkg/b", "b")
    one.finish()
    two = begin(True)
    two.write("share/pkg/b", "b")
    two.finish()
    assert not (tmp_path / "prefix/share/pkg/launch").exists()
    assert (tmp_path / "prefix/share/pkg/b").is_file()


def test_a_folder_gives_way_to_a_file(begin, tmp_path):
    (tmp_path / "prefix/share/x/y").mkdir(parents=True)
    begin(True).write("share/x", "text")
    assert (tmp_path / "prefix/share/x").read_text() == "text"
