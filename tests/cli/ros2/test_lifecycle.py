"""`ros2 lifecycle`: states and transitions of a managed node."""

import pytest

from .commands import ros2

NODE = """
import rclpy
from rclpy.lifecycle import LifecycleNode
rclpy.init()
node = LifecycleNode("managed")
rclpy.spin(node)
"""


@pytest.fixture
def managed(beside, wait_for):
    beside(NODE)
    wait_for("/managed/change_state")
    wait_for("/managed/get_transition_graph")


@pytest.mark.slow
def test_a_node_is_taken_through_its_states(env, managed):
    def lifecycle(*words):
        return ros2("lifecycle", *words, env=env)

    assert lifecycle("nodes").out == "/managed\n"
    assert lifecycle("nodes", "-c").out == "1\n"
    assert lifecycle("get", "/managed").out == "unconfigured [1]\n"
    listed = lifecycle("list", "/managed").out
    assert listed.splitlines()[:3] == ["- configure [1]", "\tStart: unconfigured", "\tGoal: configuring"]
    assert "- shutdown [5]" in listed
    assert "activate" not in listed
    assert "- activate [3]" in lifecycle("list", "-a", "/managed").out
    assert lifecycle("set", "/managed", "configure").out == "Transitioning successful\n"
    assert lifecycle("set", "/managed", "3").out == "Transitioning successful\n"
    assert lifecycle("get").out == "/managed: active [3]\n"


@pytest.mark.slow
def test_what_cannot_be_done_is_said(env, managed):
    result = ros2("lifecycle", "set", "/managed", "activate", env=env)
    assert (result.status, result.out) == (1, "")
    assert result.err.startswith("Unknown transition requested, available ones are:\n- configure [1]\n")
    result = ros2("lifecycle", "get", "/manged", env=env)
    assert (result.status, result.err) == (1, "Node not found\nDid you mean '/managed'?\n")
