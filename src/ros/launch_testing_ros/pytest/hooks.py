"""The pytest plugin for descriptions of launches that are marked ``rostest``: the launch has a ROS node."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

import pytest
from launch_testing.pytest.hooks import LaunchTestItem, LaunchTestModule

if TYPE_CHECKING:
    import pathlib


class LaunchROSTestItem(LaunchTestItem):
    """The runs of a launch that has a ROS node."""

    @classmethod
    def from_parent(cls, *args: Any, **kwargs: Any) -> Self:
        """Return the item for some runs; see `LaunchTestItem.from_parent`."""
        from launch_testing_ros.test_runner import LaunchTestRunner

        return super().from_parent(*args, **{"runner_cls": LaunchTestRunner, **kwargs})


class LaunchROSTestModule(LaunchTestModule):
    """A file that describes a launch with nodes."""

    def makeitem(self, *args: Any, **kwargs: Any) -> LaunchROSTestItem:
        """Return an item for some runs."""
        return LaunchROSTestItem.from_parent(*args, **kwargs)


def pytest_launch_collect_makemodule(path: pathlib.Path, parent: Any, entrypoint: Any) -> Any:
    """Return the collector of a file whose description is marked ``rostest``, None for any other."""
    marks = [mark for mark in getattr(entrypoint, "pytestmark", []) if mark.name == "rostest"]
    return LaunchROSTestModule.from_parent(parent=parent, path=path) if marks else None


def pytest_configure(config: pytest.Config) -> None:
    """Add the mark."""
    config.addinivalue_line(
        "markers", "rostest: mark a generate_test_description function as a launch test with a ROS node"
    )
