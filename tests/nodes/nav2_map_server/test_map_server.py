"""Maps from files to topics and back."""

import threading

import numpy as np
import pytest
from nav2_msgs.msg import CostmapFilterInfo
from nav2_msgs.srv import LoadMap, SaveMap
from nav_msgs.msg import OccupancyGrid as OccupancyGridMessage
from nav_msgs.srv import GetMap
from rclpy.lifecycle import TransitionCallbackReturn
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.task import Future

from daidalos.mapping.grid import OccupancyGrid
from daidalos.mapping.map_file import load_map, save_map
from daidalos.nodes.extensions import find_component
from daidalos.nodes.nav2_map_server._saving import MapSaverParameters, SaveRequest, save
from daidalos.nodes.nav2_map_server.costmap_filter_info_server import CostmapFilterInfoServer
from daidalos.nodes.nav2_map_server.map_saver_server import MapSaver
from daidalos.nodes.nav2_map_server.map_server import MapServer
from nodes.terminal import Terminal
from ros.graph import graph, node, spinning  # noqa: F401

TIMEOUT_S = 20.0
CELLS = np.array([[0, 100, -1], [0, 0, 100]], np.int8)


@pytest.fixture
def arena(tmp_path):
    """The YAML file of a map."""
    return save_map(OccupancyGrid(CELLS, 0.05, (-1.0, 2.0, 0.3)), tmp_path / "arena")[0]


def served(file, **parameters):
    values = {"yaml_filename": str(file), **parameters}
    return MapServer(parameter_overrides=[Parameter(name, value=value) for name, value in values.items()])


def received(node, topic="map"):  # noqa: F811
    """Return a future of the next map."""
    came = Future()
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_subscription(OccupancyGridMessage, topic, came.set_result, latched)
    return came


def result_of(future):
    done = threading.Event()
    future.add_done_callback(lambda _: done.set())
    assert done.wait(TIMEOUT_S)
    return future.result()


def call(node, kind, name, **fields):  # noqa: F811
    client = node.create_client(kind, name)
    assert client.wait_for_service(TIMEOUT_S)
    return result_of(client.call_async(kind.Request(**fields)))


def test_a_map_is_published_and_changed(node, arena, tmp_path):  # noqa: F811
    other = save_map(OccupancyGrid(-CELLS[:1], 0.1, (0.0, 0.0, 0.0)), tmp_path / "other", "raw")[0]
    (tmp_path / "broken.yaml").write_text(arena.read_text().replace("arena.pgm", "gone.pgm"))
    (tmp_path / "no.yaml").write_text("image: 1")
    server = served(arena, autostart_node=True, frame_id="world", topic_name="floor")
    first = received(node, "floor")
    with spinning(server, node):
        message = result_of(first)
        assert message.header.frame_id == "world"
        assert np.array_equal(np.array(message.data).reshape(2, 3), CELLS)
        assert message.info.origin.position.y == 2.0
        assert message.info.origin.orientation.z == pytest.approx(np.sin(0.15))
        assert call(node, GetMap, "/map_server/map").map == message
        loaded = call(node, LoadMap, "/map_server/load_map", map_url=f"file://{other}")
        assert (loaded.result, loaded.map.info.width) == (LoadMap.Response.RESULT_SUCCESS, 3)
        for name, result in (("gone", 1), ("broken", 2), ("no", 3)):
            answer = call(node, LoadMap, "/map_server/load_map", map_url=str(tmp_path / f"{name}.yaml"))
            assert answer.result == result
        assert call(node, LoadMap, "/map_server/load_map", map_url="package://no_such_package/a.yaml").result == 1
        assert call(node, GetMap, "/map_server/map").map == loaded.map
    server.destroy_node()


def test_a_map_that_can_not_be_read_keeps_the_server_from_being_configured(graph, tmp_path):  # noqa: F811
    server = served(tmp_path / "gone.yaml")
    assert server.trigger_configure() == TransitionCallbackReturn.FAILURE
    server.destroy_node()


def test_maps_are_saved_on_request(node, arena, tmp_path):  # noqa: F811
    server, saver = served(arena, autostart_node=True), MapSaver()
    with spinning(server, saver, node):
        saver.trigger_configure()
        request = {"map_topic": "map", "map_url": str(tmp_path / "copy"), "image_format": "png", "map_mode": "scale"}
        assert not call(node, SaveMap, "/map_saver/save_map", **request).result
        saver.trigger_activate()
        assert call(node, SaveMap, "/map_saver/save_map", **request).result
        assert not call(node, SaveMap, "/map_saver/save_map", **{**request, "image_format": "gif"}).result
        assert not call(node, SaveMap, "/map_saver/save_map", **{**request, "map_mode": "colour"}).result
        saver.trigger_deactivate()
        saver.trigger_cleanup()
    copy = load_map(tmp_path / "copy.yaml")
    assert np.array_equal(copy.data, CELLS)
    assert (copy.resolution, copy.origin) == (0.05, pytest.approx((-1.0, 2.0, 0.3)))
    saver.destroy_node()
    server.destroy_node()


def test_nothing_to_save(node, tmp_path):  # noqa: F811
    with spinning(node) as executor:
        assert (
            result_of(
                executor.create_task(
                    save, node, MapSaverParameters(save_map_timeout=0.1), SaveRequest("map", str(tmp_path / "none"))
                )
            )
            is False
        )
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
def test_on_the_command_line(arena, tmp_path, domain):
    arguments = ("--ros-args", "-p", f"yaml_filename:={arena}", "-p", "autostart_node:=true")
    with Terminal("run", "nav2_map_server", "map_server", *arguments, domain=domain) as server:
        server.wait_for("Read map")
        words = ("-f", "copy", "--occ", "0.7", "--free", "0.3", "--fmt", "bmp")
        with Terminal("run", "nav2_map_server", "map_saver_cli", *words, domain=domain, folder=tmp_path) as saver:
            assert saver.wait(TIMEOUT_S) == 0
        words = ("-t", "/nothing", "-f", "none", "--ros-args", "-p", "save_map_timeout:=0.1")
        with Terminal("run", "nav2_map_server", "map_saver_cli", *words, domain=domain, folder=tmp_path) as saver:
            assert saver.wait(TIMEOUT_S) == 1
            assert "nothing came on the topic '/nothing' within 0.1 s" in saver.text
        assert server.interrupt() == 0
    assert np.array_equal(load_map(tmp_path / "copy.yaml").data, CELLS)
    assert not (tmp_path / "none.yaml").exists()


def test_filter_info_is_published_when_the_server_is_activated(node):  # noqa: F811
    values = {"type": 1, "filter_info_topic": "/speed_info", "mask_topic": "/speed_mask", "base": 100.0}
    server = CostmapFilterInfoServer(parameter_overrides=[Parameter(name, value=one) for name, one in values.items()])
    came = Future()
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_subscription(CostmapFilterInfo, "speed_info", came.set_result, latched)
    with spinning(server, node):
        server.trigger_configure()
        assert not came.done()
        server.trigger_activate()
        info = result_of(came)
    assert (info.type, info.filter_mask_topic, info.base, info.multiplier) == (1, "/speed_mask", 100.0, 1.0)
    server.destroy_node()


@pytest.mark.parametrize("name", ["MapServer", "MapSaver", "CostmapFilterInfoServer"])
def test_nav2s_names_of_components(name):
    assert find_component("nav2_map_server", f"nav2_map_server::{name}").__name__ == name
