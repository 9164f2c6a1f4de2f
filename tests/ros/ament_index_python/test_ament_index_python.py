"""The resource index: prefixes, resources, packages, the command."""

import os
import sys
from argparse import Namespace
from pathlib import Path

import pytest
from ament_index_python import (
    InvalidResourceNameError,
    InvalidResourceTypeNameError,
    PackageNotFoundError,
    cli,
    get_package_prefix,
    get_package_share_directory,
    get_package_share_path,
    get_packages_with_prefixes,
    get_resource,
    get_resource_types,
    get_resources,
    get_search_paths,
    has_resource,
)
from ament_index_python.search_paths import get_all_prefixes, get_built_in_prefix

INDEX = Path("share", "ament_index", "resource_index")


@pytest.fixture
def prefixes(tmp_path, monkeypatch):
    """Two prefixes: both have `foo`, each has something of its own."""
    one, two = tmp_path / "one", tmp_path / "two"
    for prefix, resources in (
        (one, {"packages/foo": "", "packages/bar": "", "kind/foo": "content of one", "packages/.hidden": ""}),
        (two, {"packages/foo": "", "packages/baz": "", "kind/other": "content of two", "kind2/foo": ""}),
    ):
        for name, content in resources.items():
            path = prefix / INDEX / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(content)
        (prefix / "share" / "foo").mkdir()
    monkeypatch.setenv("AMENT_PREFIX_PATH", os.pathsep.join([str(one), str(two)]))
    return str(one), str(two)


def test_search_paths(prefixes, monkeypatch):
    assert get_search_paths() == list(prefixes)
    monkeypatch.setenv("AMENT_PREFIX_PATH", os.pathsep.join([prefixes[1], "/no/such/folder"]))
    assert get_search_paths() == [prefixes[1]]
    for value in ("", None):
        if value is None:
            monkeypatch.delenv("AMENT_PREFIX_PATH")
        else:
            monkeypatch.setenv("AMENT_PREFIX_PATH", value)
        with pytest.raises(EnvironmentError, match="AMENT_PREFIX_PATH"):
            get_search_paths()


def test_all_prefixes(prefixes, monkeypatch):
    assert get_all_prefixes() == [*prefixes, sys.prefix, get_built_in_prefix()]
    monkeypatch.delenv("AMENT_PREFIX_PATH")
    assert get_all_prefixes() == [sys.prefix, get_built_in_prefix()]
    monkeypatch.setenv("AMENT_PREFIX_PATH", sys.prefix)
    assert get_all_prefixes() == [sys.prefix, get_built_in_prefix()]


def test_resources(prefixes):
    one, two = prefixes
    assert get_resource("kind", "foo") == ("content of one", one)
    assert get_resource("kind", "other") == ("content of two", two)
    assert get_resources("kind") == {"foo": one, "other": two}
    assert get_resources("no_such_kind") == {}
    assert has_resource("kind", "other") == two
    assert has_resource("kind2", "foo") == two
    assert has_resource("kind", "nothing") is False
    assert {"packages", "kind", "kind2"} <= get_resource_types()
    with pytest.raises(LookupError, match="'nothing' of type 'kind'"):
        get_resource("kind", "nothing")


@pytest.mark.parametrize("function", [get_resource, has_resource])
def test_invalid_names(function):
    for arguments, error in (
        (("", "foo"), ValueError),
        (("kind", ""), ValueError),
        (("a/b", "foo"), InvalidResourceTypeNameError),
        (("kind", "a/b"), InvalidResourceNameError),
        (("kind", "a\\b"), InvalidResourceNameError),
    ):
        with pytest.raises(error):
            function(*arguments)
    with pytest.raises(InvalidResourceTypeNameError):
        get_resources("a/b")
    with pytest.raises(ValueError, match="empty"):
        get_resources("")


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="the owner of everything may read everything")
def test_unreadable_resources(prefixes):
    os.chmod(os.path.join(prefixes[0], INDEX, "kind", "foo"), 0)
    with pytest.raises(OSError, match="Could not open"):
        get_resource("kind", "foo")


def test_packages(prefixes):
    one, two = prefixes
    found = get_packages_with_prefixes()
    assert found["foo"] == one
    assert found["bar"] == one
    assert found["baz"] == two
    assert ".hidden" not in found
    assert get_package_prefix("baz") == two
    assert get_package_share_directory("foo") == os.path.join(one, "share", "foo")
    assert get_package_share_path("foo") == Path(one, "share", "foo")


def test_missing_share_folder_is_said(prefixes, recwarn):
    get_package_share_directory("bar", print_warning=False)
    assert not recwarn
    with pytest.warns(UserWarning, match="Share directory for package 'bar'"):
        get_package_share_directory("bar")


def test_unknown_packages(prefixes):
    for function in (get_package_prefix, get_package_share_directory, get_package_share_path):
        with pytest.raises(PackageNotFoundError, match=r"package 'fooo' not found, searching: \[.*did you mean 'foo'"):
            function("fooo")
    with pytest.raises(KeyError):
        get_package_prefix("nothing_like_it")
    with pytest.raises(PackageNotFoundError):
        get_package_prefix("a")
    for name in ("", "_a", "a b", "a/b", "1a", "grün"):
        with pytest.raises(ValueError, match="not a valid package name"):
            get_package_prefix(name)


def test_built_in_packages_need_no_markers(monkeypatch):
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    built_in = get_built_in_prefix()
    for package in ("std_msgs", "geometry_msgs"):
        assert get_package_prefix(package) == built_in
        assert get_resource("packages", package) == ("", built_in)
        assert get_packages_with_prefixes()[package] == built_in
        assert os.path.isfile(os.path.join(get_package_share_directory(package), "package.xml"))


def test_workspaces_come_before_what_is_built_in(prefixes):
    marker = Path(prefixes[0], INDEX, "packages", "std_msgs")
    marker.touch()
    assert get_package_prefix("std_msgs") == prefixes[0]


def test_command(prefixes, capsys):
    one, two = prefixes
    assert cli.main([]) is None
    assert {"packages", "kind", "kind2"} <= set(capsys.readouterr().out.split())
    assert cli.main(["kind"]) is None
    assert capsys.readouterr().out.splitlines() == [f"foo\t{one}", f"other\t{two}"]
    assert cli.main(["kind", "foo"]) is None
    assert capsys.readouterr().out.splitlines() == [one, "content of one"]
    assert "Could not find the resource" in cli.main(["kind", "nothing"])


def test_completion(prefixes):
    assert set(cli.resource_type_completer("kind")) == {"kind", "kind2"}
    arguments = Namespace(resource_type="kind")
    assert list(cli.resource_name_completer("f", parsed_args=arguments)) == ["foo"]
    assert cli.resource_name_completer("f", parsed_args=Namespace()) == []
