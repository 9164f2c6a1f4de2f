"""`ros2 run rmw_zenoh_cpp rmw_zenohd`: starts, says where it listens, ends at Ctrl-C; errors in one line."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys

import pytest

ROUTER = [sys.executable, "-m", "daidalos.cli.ros2", "run", "rmw_zenoh_cpp", "rmw_zenohd"]


@pytest.fixture
def port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def start(port: int, **variables: str) -> subprocess.Popen[str]:
    override = {"ZENOH_CONFIG_OVERRIDE": f'listen/endpoints=["tcp/127.0.0.1:{port}"]'}
    return subprocess.Popen(
        ROUTER, env=os.environ | override | variables, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        start_new_session=True,
    )  # fmt: skip


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="sends signals to a group of processes")
def test_it_runs_until_ctrl_c(port):
    router = start(port)
    try:
        assert router.stdout.readline().startswith("Started Zenoh router with id ")
        assert router.stdout.readline() == f"listening at tcp/127.0.0.1:{port}\n"
        with socket.create_connection(("127.0.0.1", port), 5.0):
            pass
        second = start(port)
        _, words = second.communicate(timeout=30)
        assert second.returncode == 2
        assert words.startswith("error: the router cannot start: ")
        assert len(words.splitlines()) == 1
        os.killpg(router.pid, signal.SIGINT)
        _, words = router.communicate(timeout=30)
        assert (router.returncode, words) == (0, "")
    finally:
        if router.poll() is None:
            os.killpg(router.pid, signal.SIGKILL)
            router.communicate()


def test_a_configuration_that_is_not_there_is_named(port, tmp_path):
    router = start(port, ZENOH_ROUTER_CONFIG_URI=str(tmp_path / "none.json5"))
    _, words = router.communicate(timeout=30)
    assert router.returncode == 2
    assert "ZENOH_ROUTER_CONFIG_URI" in words
    assert "Traceback" not in words
