"""What the tests of launch share: log files and an environment of their own, and a way to run descriptions."""

import sys

import pytest

from ros.launching import sandbox

__all__ = ["python", "run_launch", "sandbox"]


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
