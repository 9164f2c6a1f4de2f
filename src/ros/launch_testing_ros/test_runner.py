"""Runs of launched systems with their tests, for launch files with ROS nodes."""

from __future__ import annotations

from launch_testing.test_runner import LaunchTestRunner as _LaunchTestRunner


class LaunchTestRunner(_LaunchTestRunner):
    """Runner that executes some runs one after another; it adds no node to the graph that the tests look at."""
