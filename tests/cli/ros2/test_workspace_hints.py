"""Hints about workspaces: what was forgotten, source, build, or the entry in setup.py."""

import os

import pytest

from daidalos.cli.ros2.workspace_hints import unknown_executable, unknown_package

MANIFEST = '<package format="3"><name>mine</name></package>'
needs_posix = pytest.mark.skipif(os.name != "posix", reason="whether a file can be run is a question of POSIX")


@pytest.fixture
def workspace(tmp_path, monkeypatch):
    source = tmp_path / "src" / "group" / "mine"
    source.mkdir(parents=True)
    (source / "package.xml").write_text(MANIFEST)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def installed(workspace, monkeypatch):
    prefix = workspace / "install" / "mine"
    for folder in ("share/mine", "lib/mine", "share/ament_index/resource_index/packages"):
        (prefix / folder).mkdir(parents=True)
    (prefix / "share/mine/package.xml").write_text(MANIFEST)
    (prefix / "share/ament_index/resource_index/packages/mine").touch()
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(prefix))
    return prefix


def test_a_package_that_is_not_built(workspace, monkeypatch):
    monkeypatch.chdir(workspace / "src")
    hint = unknown_package("mine")
    assert hint.startswith("\n")
    assert f"run 'colcon build' in '{workspace}'" in hint


def test_a_package_that_is_not_sourced(installed, workspace):
    assert f"source {workspace / 'install' / 'setup.bash'}" in unknown_package("mine")


def test_a_package_that_is_nowhere(workspace):
    assert unknown_package("others") == ""


def test_an_executable_without_entry(installed, workspace):
    setup = workspace / "src" / "group" / "mine" / "setup.py"
    setup.write_text("setup(entry_points={'console_scripts': ['other = mine.other:main']})")
    assert f"Name it under console_scripts in '{setup}'" in unknown_executable("mine", "talker")


def test_an_executable_that_was_named_after_the_build(installed, workspace):
    setup = workspace / "src" / "group" / "mine" / "setup.py"
    setup.write_text("setup(entry_points={'console_scripts': ['talker = mine.talker:main']})")
    assert unknown_executable("mine", "talker") == f"\n'{setup}' names it: run 'colcon build' in '{workspace}' again"


def test_an_executable_of_a_package_with_cmake(installed, workspace):
    assert "CMakeLists.txt' install it to lib/mine?" in unknown_executable("mine", "talker.py")


@needs_posix
def test_a_script_that_is_not_executable(installed, workspace):
    script = workspace / "src" / "group" / "mine" / "talker.py"
    script.write_text("#!/usr/bin/env python3\n")
    script.chmod(0o644)
    (installed / "lib" / "mine" / "talker.py").symlink_to(script)
    assert f"chmod +x {script.resolve()}" in unknown_executable("mine", "talker.py")
