"""The graph that these tests use, and an empty blackboard."""

import py_trees
import pytest

from ros.graph import graph, node

__all__ = ["graph", "node"]


@pytest.fixture(autouse=True)
def blackboard():
    """An empty blackboard."""
    py_trees.blackboard.Blackboard.enable_activity_stream()
    py_trees.blackboard.Blackboard.disable_activity_stream()
    py_trees.blackboard.Blackboard.clear()
