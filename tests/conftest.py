"""Fixtures that every test may use."""

import itertools
import os
from pathlib import Path

import pytest

from places import REPOSITORY

# Options meant for this run are not for the pytest that a test starts, which may know other plugins.
os.environ.pop("PYTEST_ADDOPTS", None)

_numbers = itertools.count(os.getpid())


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """The folder of real logs, worlds and test vectors; a test that needs it is skipped where it is absent."""
    folder = Path(os.environ.get("DAIDALOS_SHARED_DATA", REPOSITORY.parent / "shared" / "data"))
    if not folder.is_dir():
        pytest.skip(f"no shared data at {folder}; set DAIDALOS_SHARED_DATA")
    return folder


@pytest.fixture
def domain() -> int:
    """A ROS domain in which most likely nobody else is."""
    return 100 + next(_numbers) % 100
