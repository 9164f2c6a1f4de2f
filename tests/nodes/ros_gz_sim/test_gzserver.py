"""The simulator as a component: its world is a parameter, and it runs at once."""

from threading import Event
from typing import Any

import pytest
from rclpy.node import Node
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock

from daidalos.nodes.extensions import find_component
from daidalos.nodes.ros_gz_sim.gzserver import GzServer
from daidalos.nodes.runner import UserError
from ros.graph import graph, node, spinning  # noqa: F401

WORLD = """<sdf version="1.9"><world name="w"><model name="{}"><static>true</static><link name="link"/></model>
  </world></sdf>"""


def make(**parameters: str) -> GzServer:
    return GzServer(parameter_overrides=[Parameter(name, value=value) for name, value in parameters.items()])


def models(server: GzServer) -> set[str]:
    return set(server._paced.simulation.models)


def test_a_container_finds_it_under_its_name():
    assert find_component("ros_gz_sim", "ros_gz_sim::GzServer") is GzServer


def test_the_world_is_a_parameter_and_time_goes_on(node: Node, tmp_path: Any):  # noqa: F811
    file = tmp_path / "hut.sdf"
    file.write_text(WORLD.format("hut"))
    server = make(world_sdf_file=str(file), world_sdf_string=WORLD.format("left_out"))
    ticked = Event()
    try:
        assert models(server) == {"hut"}
        node.create_subscription(Clock, "/clock", lambda message: ticked.set(), 1)
        with spinning(node):
            assert ticked.wait(60.0)
    finally:
        server.destroy_node()


def test_the_world_may_be_given_as_text(graph: Any):  # noqa: F811
    server = make(world_sdf_string=WORLD.format("shed"))
    try:
        assert models(server) == {"shed"}
    finally:
        server.destroy_node()


def test_a_missing_file_is_named_with_its_parameter(graph: Any):  # noqa: F811
    with pytest.raises(UserError, match=r"'world_sdf_file': there is no world file 'shop\.sdf'"):
        make(world_sdf_file="shop.sdf")
