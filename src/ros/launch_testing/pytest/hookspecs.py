"""The hooks that this plugin calls."""

from __future__ import annotations

import pathlib
from typing import Any

import pytest


@pytest.hookspec(firstresult=True)
def pytest_launch_collect_makemodule(path: pathlib.Path, parent: Any, entrypoint: Any) -> Any:
    """Return the collector of a file that describes a launch.

    Parameters
    ----------
    path
        The file.
    parent
        The collector around it.
    entrypoint
        The file's function `generate_test_description`.
    """
