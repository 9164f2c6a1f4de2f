"""Sessions over each middleware, in a runtime folder of the test's own."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from daidalos.transport.environment import Environment
from daidalos.transport.session import Session
from daidalos.transport.shared import make_backend

MIDDLEWARES = ("rmw_zenoh_cpp", "rmw_cyclonedds_cpp")


@pytest.fixture(autouse=True)
def _own_runtime_folder(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> None:
    """Keep what runs on this machine besides out of the tests, and the tests out of that."""
    folder: Path = tmp_path_factory.mktemp("run")
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(folder))
    for name in (
        "ROS_DOMAIN_ID", "RMW_IMPLEMENTATION", "ROS_AUTOMATIC_DISCOVERY_RANGE", "ROS_STATIC_PEERS",
        "ZENOH_SESSION_CONFIG_URI", "ZENOH_ROUTER_CONFIG_URI", "ZENOH_CONFIG_OVERRIDE", "CYCLONEDDS_URI",
    ):  # fmt: skip
        monkeypatch.delenv(name, raising=False)


@pytest.fixture(params=MIDDLEWARES)
def middleware(request: pytest.FixtureRequest) -> str:
    """The name of a middleware; one that is not installed is skipped."""
    name: str = request.param
    if name == "rmw_cyclonedds_cpp" and importlib.util.find_spec("cyclonedds") is None:
        pytest.skip("the extra 'dds' is not installed")
    return name


@pytest.fixture
def new_session(middleware: str, domain: int) -> Iterator[Callable[[], Session]]:
    """What opens a session; each is as if in a process of its own."""
    sessions: list[Session] = []

    def make() -> Session:
        sessions.append(Session(make_backend(Environment(domain, middleware=middleware))))
        return sessions[-1]

    yield make
    for session in sessions:
        session.close()
