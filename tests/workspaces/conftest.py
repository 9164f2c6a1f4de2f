"""Terminals that end with the test, and a workspace in a folder of its own."""

import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from terminals import Terminal

DOMAIN = 55
collect_ignore = ["test_colcon.py", "test_mistakes.py"] if sys.platform == "win32" else []


@pytest.fixture(scope="module")
def workspace(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An empty workspace."""
    folder = tmp_path_factory.mktemp("home") / "ros2_ws"
    (folder / "src").mkdir(parents=True)
    return folder


@pytest.fixture
def terminal(workspace: Path) -> Iterator["Callable[[], Terminal]"]:
    """Opens terminals in the workspace."""
    from terminals import Terminal, environment

    opened = []

    def open_one() -> Terminal:
        opened.append(Terminal(environment(DOMAIN, workspace.parent), workspace))
        return opened[-1]

    yield open_one
    for one in opened:
        one.close()
