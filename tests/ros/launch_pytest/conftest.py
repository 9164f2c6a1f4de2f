"""Each test has its own log files and environment; runs of pytest within it name the plugin that they need."""

import pytest

from ros.launching import sandbox

__all__ = ["no_plugins", "sandbox"]


@pytest.fixture(autouse=True)
def no_plugins(sandbox, monkeypatch):
    """Turn off the search for plugins in the runs of pytest that a test makes."""
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
