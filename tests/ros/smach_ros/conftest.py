"""The graph that these tests use."""

import pytest
import rclpy
import smach

from ros.graph import graph, node

__all__ = ["graph", "node"]


@pytest.fixture(autouse=True)
def shutdown_check():
    """Machines end with the default context, whatever other tests have set."""
    smach.set_shutdown_check(lambda: not rclpy.ok())
