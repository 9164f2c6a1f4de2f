"""What the tests of launch share: log files and an environment of their own, and a way to run descriptions."""

import os
import sys

import pytest


@pytest.fixture(autouse=True)
def sandbox(tmp_path, monkeypatch):
    """Give each test its own log files and environment."""
    import launch.logging

    environment = dict(os.environ)
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "log"))
    for name in ("OVERRIDE_LAUNCH_PROCESS_OUTPUT", "OVERRIDE_LAUNCH_SCREEN_FORMAT", "OVERRIDE_LAUNCH_LOG_FORMAT"):
        monkeypatch.delenv(name, raising=False)
    launch.logging.reset()
    yield
    launch.logging.reset()
    os.environ.clear()
    os.environ.update(environment)


@pytest.fixture
def run_launch():
    """Run entities as one launch and return the service."""
    from launch import LaunchDescription, LaunchService

    def run(*entities, expected=0):
        service = LaunchService()
        service.include_launch_description(LaunchDescription(list(entities)))
        assert service.run() == expected
        return service

    return run


@pytest.fixture
def python():
    """Make the action that runs a Python program."""
    from launch.actions import ExecuteProcess

    def make(program, *arguments, **kwargs):
        return ExecuteProcess(cmd=[sys.executable, "-u", "-c", program, *arguments], **kwargs)

    return make
