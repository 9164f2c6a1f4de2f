"""`ros2 component`: nodes that are loaded into a running container."""

import pytest

from .commands import ros2

CONTAINER = """
import sys
from daidalos.nodes.rclcpp_components.component_container import main
sys.exit(main())
"""


@pytest.fixture
def container(beside, wait_for):
    beside(CONTAINER)
    wait_for("/ComponentManager/_container/load_node")


@pytest.mark.slow
def test_components_are_loaded_listed_and_unloaded(env, container):
    def component(*words):
        return ros2("component", *words, env=env)

    loaded = component("load", "/ComponentManager", "demo_nodes_cpp", "demo_nodes_cpp::Talker")
    assert loaded.out == "Loaded component 1 into '/ComponentManager' container node as '/talker'\n"
    options = ("-n", "ear", "--node-namespace", "/lab", "-r", "chatter:=/chatter", "-p", "use_sim_time:=false")
    loaded = component("load", "-q", "/ComponentManager", "demo_nodes_cpp", "demo_nodes_cpp::Listener", *options)
    assert loaded.out == "2  /lab/ear\n"
    assert component("list").out == "/ComponentManager\n  1  /talker\n  2  /lab/ear\n"
    assert component("list", "--containers-only").out == "/ComponentManager\n"
    unloaded = component("unload", "/ComponentManager", "1")
    assert unloaded.out == "Unloaded component 1 from '/ComponentManager' container node\n"
    assert component("list", "/ComponentManager").out == "2  /lab/ear\n"


@pytest.mark.slow
def test_what_is_not_there_cannot_be_loaded_or_unloaded(env, container):
    result = ros2("component", "load", "/ComponentManager", "demo_nodes_cpp", "demo_nodes_cpp::Talkr", env=env)
    assert (result.status, result.out) == (1, "")
    assert "demo_nodes_cpp::Talker" in result.err
    result = ros2("component", "unload", "/ComponentManager", "7", env=env)
    assert (result.status, result.out) == (1, "")
    assert result.err.startswith("Failed to unload component 7 from '/ComponentManager' container node")
    result = ros2("component", "list", "/ComponentManagr", env=env)
    assert (result.status, result.err) == (
        1,
        "Unable to find container node '/ComponentManagr'\nDid you mean '/ComponentManager'?\n",
    )


@pytest.mark.slow
def test_components_that_could_be_loaded(env):
    assert "demo_nodes_cpp\n  demo_nodes_cpp::AddTwoIntsServer\n" in ros2("component", "types", env=env).out
    listed = ros2("component", "types", "demo_nodes_cpp", env=env).out.split()
    assert {"demo_nodes_cpp::Listener", "demo_nodes_cpp::Talker"} <= set(listed)
