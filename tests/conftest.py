"""Fixtures that every test may use."""

import os
import tempfile
from collections.abc import Iterator
from pathlib import Path

import hypothesis
import pytest

from domains import reserved_domain
from places import REPOSITORY
from properties import FULL

# Options meant for this run are not for the pytest that a test starts, which may know other plugins.
os.environ.pop("PYTEST_ADDOPTS", None)

# How long an example takes says more of the machine's other work than of the code; slowness has its own tests.
hypothesis.settings.register_profile("daidalos", max_examples=FULL, deadline=None)
hypothesis.settings.register_profile("quick", max_examples=FULL // 5, deadline=None)
hypothesis.settings.load_profile("daidalos")


def pytest_configure(config: pytest.Config) -> None:
    """Try fewer examples of properties in the quick suite."""
    if "not slow" in config.option.markexpr:
        hypothesis.settings.load_profile("quick")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Leave tests with limits in real time out of the quick suite, which runs in parallel."""
    for item in items:
        if item.get_closest_marker("timing"):
            item.add_marker("slow")


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    """Tear down what was kept for a test that another process has stolen meanwhile (``--dist worksteal``).

    The test before was told that the stolen one follows, so that its module or class was kept; without this the next
    test of another module fails with "previous item was not torn down properly".
    """
    item.session._setupstate.teardown_exact(item)


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """The folder of real logs, worlds and test vectors; a test that needs it is skipped where it is absent."""
    folder = Path(os.environ.get("DAIDALOS_SHARED_DATA", REPOSITORY.parent / "shared" / "data"))
    if not folder.is_dir():
        pytest.skip(f"no shared data at {folder}; set DAIDALOS_SHARED_DATA")
    return folder


@pytest.fixture(scope="session", autouse=True)
def _folders_of_the_run(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Keep the processes of this run, and those of others on this machine, from finding each other.

    Temporary files of all of them go to one folder, which is deleted with what killed processes left there.
    """
    tmp_path_factory.getbasetemp()  # is kept for whoever looks at a failure
    with (
        # Not pytest's own folder: the paths of sockets may not be long.
        tempfile.TemporaryDirectory(prefix="dt-", ignore_cleanup_errors=True) as folder,
        pytest.MonkeyPatch.context() as patch,
    ):
        patch.setenv("XDG_RUNTIME_DIR", folder)
        temporary = Path(folder, "tmp")
        temporary.mkdir()
        patch.setenv("TMPDIR", str(temporary))
        patch.setattr(tempfile, "tempdir", str(temporary))
        yield


@pytest.fixture
def domain() -> Iterator[int]:
    """A ROS domain that no other test of any run on this machine has at the same time."""
    with reserved_domain() as number:
        yield number
