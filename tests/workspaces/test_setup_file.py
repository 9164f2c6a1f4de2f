"""What is asked of a setup.py, and its mistakes."""

import os
import re
from pathlib import Path

import pytest

from daidalos.workspaces.colcon.setup_file import options
from daidalos.workspaces.errors import WorkspaceError

_GOOD = """from setuptools import setup

setup(
    name="talkers",
    packages=["talkers"],
    data_files=[("share/talkers", ["package.xml"])],
    tests_require=["pytest"],
    entry_points={"console_scripts": ["talker = talkers.talker:main"]},
)
"""


def _options(folder: Path, text: str) -> dict[str, object]:
    path = folder / "setup.py"
    path.write_text(text)
    return options(path, os.environ)


def test_the_arguments_are_found(tmp_path: Path) -> None:
    found = _options(tmp_path, _GOOD)
    assert found["packages"] == ["talkers"]
    assert found["data_files"] == [("share/talkers", ["package.xml"])]
    assert found["metadata"]["name"] == "talkers"


def test_what_it_prints_itself_does_no_harm(tmp_path: Path) -> None:
    assert _options(tmp_path, f"print('hello')\n{_GOOD}")["packages"] == ["talkers"]


@pytest.mark.parametrize(
    ("old", "new", "problem"),
    [
        ("setup(\n", "setup((\n", "setup.py:3: SyntaxError: '(' was never closed"),
        ('["package.xml"]', '[os.path.join("package.xml")]', "setup.py:6: NameError: name 'os' is not defined"),
        ("from setuptools", "from setuptool", "setup.py:1: ModuleNotFoundError: No module named 'setuptool'"),
        (
            ":main",
            "",
            "setup.py:3: ValueError: console_scripts: 'talker = talkers.talker' is not 'name = ",
        ),
        (
            "talker =",
            "talker:",
            "ValueError: console_scripts: 'talker: talkers.talker:main' is not 'name =",
        ),
        (':main"', ':main" "b = talkers.b:main"', "'talker = talkers.talker:mainb = talkers.b:main' is not 'name ="),
        ("setup(\n", "dict(\n", "setup.py: it does not call setup()"),
    ],
)
def test_a_mistake_is_one_line(tmp_path: Path, old: str, new: str, problem: str) -> None:
    with pytest.raises(WorkspaceError, match=re.escape(problem)) as caught:
        _options(tmp_path, _GOOD.replace(old, new))
    assert "\n" not in str(caught.value)
