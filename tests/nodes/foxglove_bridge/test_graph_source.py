"""The studio's source listens only to what is there, and hears of the rest when it comes."""

from __future__ import annotations

import contextlib
import sys
import threading
from collections.abc import Sequence
from pathlib import Path

import pytest
from daidalos_msgs.srv import GetShapes
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.serialization import serialize_message
from rosgraph_msgs.msg import Clock
from std_msgs.msg import String
from visualization_msgs.msg import Marker

from daidalos.nodes.foxglove_bridge._graph_source import RosGraphSource
from daidalos.nodes.studio import Studio
from daidalos.studio.assets import AssetError
from daidalos.studio.source import Parameter, SourceError
from ros.graph import graph, node, spinning  # noqa: F401


class Watcher:
    """An observer that waits."""

    def __init__(self) -> None:
        self.times: list[int] = []
        self.told = threading.Event()

    def graph_changed(self) -> None:
        pass

    def time_advanced(self, nanoseconds: int) -> None:
        self.times.append(nanoseconds)
        self.told.set()

    def parameters_changed(self, parameters: Sequence[Parameter]) -> None:
        pass


def names(node: Node) -> set[str]:  # noqa: F811
    return {name for name, _ in node.get_topic_names_and_types()}


def test_a_clock_is_heard_once_there_is_one(node: Node) -> None:  # noqa: F811
    source, watcher = RosGraphSource(node), Watcher()
    with spinning(node):
        watching = source.attach(watcher)
        assert "/clock" not in names(node)
        publisher = node.create_publisher(Clock, "/clock", 1)
        clock = Clock()
        clock.clock.sec = 7
        while not watcher.told.wait(0.05):
            publisher.publish(clock)
        assert source.time() == watcher.times[0] == 7_000_000_000
        watching.close()
    source.close()


def test_a_clock_that_is_there_already_is_heard(node: Node) -> None:  # noqa: F811
    publisher = node.create_publisher(Clock, "/clock", 1)
    source, watcher = RosGraphSource(node), Watcher()
    with spinning(node):
        watching = source.attach(watcher)
        while not watcher.told.wait(0.05):
            publisher.publish(Clock())
        watching.close()
    source.close()


def test_nothing_from_the_graph_widens_what_the_page_may_fetch(node: Node, tmp_path: Path) -> None:  # noqa: F811
    mesh = tmp_path / "rock.stl"
    mesh.write_bytes(b"rock")

    def answer(request: GetShapes.Request, response: GetShapes.Response) -> GetShapes.Response:
        response.shapes = [Marker(mesh_resource=mesh.as_uri())]
        return response

    node.create_service(GetShapes, "/gazebo/get_shapes", answer)
    with spinning(node):
        studio = Studio(node, port=0)
        assert studio.url("plot", topic="/a b").endswith("/?panel=plot&topic=/a+b")
        assert studio.url(front="simulation").endswith("/?front=simulation")
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        publisher = node.create_publisher(String, "arm/robot_description", latched)
        publisher.publish(String(data=f'<mesh filename="{mesh.as_uri()}"/>'))
        studio._source.call("/gazebo/get_shapes", serialize_message(GetShapes.Request())).result(10.0)
        assets = studio._server._assets
        assert assets is not None
        with pytest.raises(AssetError, match="outside of"):
            assets.read(mesh.as_uri())
        studio.close()


@pytest.mark.parametrize("topic", ["/" + "a" * 100_000, "/a b", "/\x00", "", "/a//b", "/1a"])
def test_a_client_cannot_advertise_a_name_that_ros_refuses(node: Node, topic: str) -> None:  # noqa: F811
    source = RosGraphSource(node)
    with pytest.raises(SourceError):
        source.advertise(topic, "std_msgs/msg/String")
    assert not [name for name in names(node) if name.startswith("/a")]


@pytest.mark.parametrize(
    "type_name", ["antigravity/msg/X", "os/msg/path", "../../x/msg/Y", "std_msgs/msg/Nothing", "x"]
)
def test_a_type_name_imports_interfaces_only(node: Node, type_name: str) -> None:  # noqa: F811
    sys.modules.pop("antigravity", None)
    with pytest.raises(SourceError, match="not known"):
        RosGraphSource(node).advertise("/a", type_name)
    assert "antigravity" not in sys.modules


@pytest.mark.parametrize(
    "name", ["/no such node.x", "x", ".", "/tested.1 bad", "/tested.", "\x00.y", "/" + "n" * 5000 + ".p"]
)
def test_a_request_for_impossible_parameters_fails_alone(node: Node, name: str) -> None:  # noqa: F811
    source = RosGraphSource(node)
    node.declare_parameter("speed", 1.5)
    with spinning(node):
        for request in (source.get_parameters([name]), source.set_parameters([Parameter(name, 3)])):
            with contextlib.suppress(SourceError):
                request.result(5.0)
        assert [one.value for one in source.get_parameters(["/tested.speed"]).result(5.0)] == [1.5]


@pytest.mark.slow
def test_a_node_that_does_not_answer_delays_the_others_once_and_leaves_nothing(node: Node) -> None:  # noqa: F811
    source = RosGraphSource(node)
    node.declare_parameter("speed", 1.5)
    idle = Node("idle", context=node.context)
    with spinning(node):
        for _ in range(3):
            found = source.get_parameters([]).result(10.0)
            assert [one.value for one in found if one.name == "/tested.speed"] == [1.5]
        assert source.get_parameters(["/idle.use_sim_time"]).result(0.5) == []
        idle.destroy_node()
        source.get_parameters(["/tested.speed"]).result(5.0)
        assert not [client for client in node.clients if client.srv_name.startswith("/idle/")]
