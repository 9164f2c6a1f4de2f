"""Files named by addresses."""

import urllib.error

import pytest
from ament_index_python.packages import PackageNotFoundError, get_package_share_directory
from resource_retriever import get, get_filename

NAME = "package://turtlesim/package.xml"


def test_a_file_in_a_package():
    path = f"{get_package_share_directory('turtlesim')}/package.xml"
    assert get_filename(NAME) == f"file://{path}"
    assert get_filename(NAME, use_protocol=False) == path
    assert b"<name>turtlesim</name>" in get(NAME)


def test_any_other_address_stays(tmp_path):
    file = tmp_path / "a b.txt"
    file.write_bytes(b"content")
    assert get_filename(file.as_uri()) == file.as_uri()
    assert get(file.as_uri()) == b"content"


def test_what_is_not_there(tmp_path):
    for call in (get, get_filename):
        with pytest.raises(PackageNotFoundError):
            call("package://no_such_package/a")
        for name in ("package://turtlesim", "package://", "package:///a", "package://turtlesim/"):
            with pytest.raises(ValueError, match="names no file in a package"):
                call(name)
    with pytest.raises(FileNotFoundError):
        get("package://turtlesim/no_such_file")
    with pytest.raises(urllib.error.URLError):
        get((tmp_path / "none").as_uri())
