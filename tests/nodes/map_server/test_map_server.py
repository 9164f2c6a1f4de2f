"""ROS 1's server and saver of maps."""

import sys

import numpy as np
import pytest
from nav_msgs.msg import MapMetaData
from nav_msgs.msg import OccupancyGrid as OccupancyGridMessage
from nav_msgs.srv import GetMap, LoadMap

from daidalos.mapping.errors import MapFileError
from daidalos.mapping.grid import OccupancyGrid
from daidalos.mapping.map_file import load_map, save_map
from daidalos.nodes.map_server import map_saver
from daidalos.nodes.map_server.map_server import Ros1MapServer
from daidalos.nodes.qos import LATCHED
from nodes.nav2_map_server.test_map_server import call, received, result_of
from ros.graph import graph, node, spinning  # noqa: F401

CELLS = np.array([[0, 100, -1], [0, 0, 100]], np.int8)


@pytest.fixture
def arena(tmp_path):
    """The YAML file of a map."""
    return save_map(OccupancyGrid(CELLS, 0.05, (-1.0, 2.0, 0.0)), tmp_path / "arena")[0]


def test_a_map_is_served_and_changed(node, arena, tmp_path):  # noqa: F811
    other = save_map(OccupancyGrid(CELLS[:1], 0.1, (0.0, 0.0, 0.0)), tmp_path / "other")[0]
    server = Ros1MapServer(str(arena))
    first, infos = received(node), []
    node.create_subscription(MapMetaData, "map_metadata", infos.append, LATCHED)
    with spinning(server, node):
        message = result_of(first)
        assert np.array_equal(np.array(message.data).reshape(2, 3), CELLS)
        assert call(node, GetMap, "static_map").map == message
        assert call(node, LoadMap, "change_map", map_url=str(other)).map.info.height == 1
        missing = call(node, LoadMap, "change_map", map_url=str(tmp_path / "gone.yaml"))
        assert missing.result == LoadMap.Response.RESULT_MAP_DOES_NOT_EXIST
        assert call(node, GetMap, "static_map").map.info.height == 1
    assert [info.height for info in infos] == [2, 1]
    server.destroy_node()


def test_a_missing_file_is_named(graph, tmp_path):  # noqa: F811
    with pytest.raises(MapFileError, match=r"gone\.yaml"):
        Ros1MapServer(str(tmp_path / "gone.yaml"))


def test_arguments_of_the_saver(monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["map_saver", "--occ", "90", "--free", "10", "-f", "a", "map:=/floor"])
    given = map_saver._parse()
    assert (given.occ, given.free, given.stem, given.topic) == (90.0, 10.0, "a", "/floor")
    for words in (["--occ", "140"], ["topic"]):
        monkeypatch.setattr(sys, "argv", ["map_saver", *words])
        with pytest.raises(SystemExit):
            map_saver._parse()
    printed = capsys.readouterr().err
    assert "expected a percentage from 0 to 100, found 140" in printed
    assert "expected map:=TOPIC, found topic" in printed


def test_a_map_is_saved(monkeypatch, tmp_path):
    import rclpy

    monkeypatch.setenv("RMW_IMPLEMENTATION", "rmw_daidalos_inprocess")
    monkeypatch.setattr(sys, "argv", ["map_saver", "-f", str(tmp_path / "saved")])
    monkeypatch.setattr(map_saver, "run_program", lambda body, interrupted: body())
    context = rclpy.Context()
    rclpy.init(args=[], context=context)
    publisher_node = rclpy.create_node("publisher", context=context)
    message = OccupancyGridMessage(data=[0, 100])
    message.info.width, message.info.height, message.info.resolution = 2, 1, 0.05
    publisher_node.create_publisher(OccupancyGridMessage, "map", LATCHED).publish(message)
    try:
        assert map_saver.main() == 0
    finally:
        rclpy.try_shutdown()
        rclpy.try_shutdown(context=context)
        context.destroy()
    assert load_map(tmp_path / "saved.yaml").data.tolist() == [[0, 100]]
