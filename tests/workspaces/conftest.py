"""Terminals that end with the test, and a workspace in a folder of its own."""

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from terminals import Terminal, environment

DOMAIN = 55


@pytest.fixture(scope="module")
def workspace(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An empty workspace."""
    folder = tmp_path_factory.mktemp("home") / "ros2_ws"
    (folder / "src").mkdir(parents=True)
    return folder


@pytest.fixture
def terminal(workspace: Path) -> Iterator[Callable[[], Terminal]]:
    """Opens terminals in the workspace."""
    opened = []

    def open_one() -> Terminal:
        opened.append(Terminal(environment(DOMAIN, workspace.parent), workspace))
        return opened[-1]

    yield open_one
    for one in opened:
        one.close()
