"""What the tests of this package share: log files and an environment of their own, as far as they need one."""

import os

import pytest


@pytest.fixture(autouse=True)
def sandbox(tmp_path, monkeypatch):
    """Give each test its own log files and environment."""
    import launch.logging

    environment = dict(os.environ)
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "log"))
    monkeypatch.delenv("OVERRIDE_LAUNCH_PROCESS_OUTPUT", raising=False)
    # Runs of pytest within a test name the plugin that they need.
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    launch.logging.reset()
    yield
    launch.logging.reset()
    os.environ.clear()
    os.environ.update(environment)
