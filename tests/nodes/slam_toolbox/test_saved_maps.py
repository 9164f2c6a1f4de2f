"""Nodes of slam_toolbox with saved maps: saved by one, localized in and gone on from by others."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from geometry_msgs.msg import Pose2D, PoseWithCovarianceStamped
from nav_msgs.msg import OccupancyGrid
from nav_msgs.srv import GetMap
from rclpy.lifecycle import TransitionCallbackReturn
from rclpy.task import Future
from slam_toolbox.srv import (
    AddSubmap,
    Clear,
    ClearQueue,
    DeserializePoseGraph,
    LoopClosure,
    MergeMaps,
    Pause,
    SerializePoseGraph,
    ToggleInteractive,
)
from std_srvs.srv import Empty, SetBool
from visualization_msgs.msg import InteractiveMarkerFeedback, MarkerArray

from daidalos.common import pose2
from daidalos.mapping.pose_graph_file import load_pose_graph
from daidalos.nodes.conversions import grid_array, pose_message
from daidalos.nodes.slam_toolbox.lifelong_slam_toolbox_node import LifelongSlamToolbox
from daidalos.nodes.slam_toolbox.localization_slam_toolbox_node import LocalizationSlamToolbox
from daidalos.nodes.slam_toolbox.map_and_localization_slam_toolbox_node import MapAndLocalizationSlamToolbox
from daidalos.nodes.slam_toolbox.merge_maps_kinematic import MergeMapsKinematic
from daidalos.nodes.slam_toolbox.sync_slam_toolbox_node import SynchronousSlamToolbox
from nodes.slam_toolbox.test_async_slam_toolbox_node import PARAMETERS, TOUR, Bench, compiled  # noqa: F401
from nodes.stepped import LATCHED, Stage

pytestmark = [pytest.mark.usefixtures("compiled"), pytest.mark.timeout(300)]

Start = Callable[..., Bench]


@pytest.fixture
def start(stage: Callable[[dict[str, Any]], Stage]) -> Start:
    """Return a function that starts a kind of node with parameters beside the usual ones."""

    def start(make: Callable[[], Any], **parameters: Any) -> Bench:
        return Bench(stage({"/slam_toolbox": {**PARAMETERS["/slam_toolbox"], **parameters}}), make)

    return start


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Save the pose graph of a tour through the arena."""
    from daidalos.mapping.pose_graph_file import save_pose_graph
    from daidalos.mapping.slam import Slam, SlamConfig
    from mapping.worlds import arena, drive
    from nodes.slam_toolbox.test_async_slam_toolbox_node import LIDAR, RATE

    slam, rng = Slam(SlamConfig(match_every_scan=True)), np.random.default_rng(7)
    for k, pose in enumerate(drive(TOUR, speed=0.8, rate=RATE)):
        slam.add_scan(round(k * 1e9 / RATE), LIDAR.scan(arena(), pose, rng), pose)
    stem = tmp_path_factory.mktemp("maps") / "arena"
    save_pose_graph(slam.saved(), stem)
    return stem


PLACE = np.array([1.0, -2.0, 0.3])
"""Where the robot is in the saved map; its odometry begins at 0 there."""


def offset(bench: Bench) -> float:
    """Return how far the node's map->odom is from the truth, the robot standing at `PLACE` with odometry 0."""
    return float(np.hypot(*(bench.believed(np.zeros(3)) - PLACE[:2])))


def stand(bench: Bench, condition: Callable[[], bool]) -> None:
    """Look from `PLACE` until a condition holds."""
    for _ in range(200):
        bench.look(PLACE, np.zeros(3))
        if condition():
            return
    pytest.fail("the condition did not come to hold")


@pytest.mark.slow
def test_the_robot_is_localized_in_a_saved_map(start: Start, saved: Path, capfd: pytest.CaptureFixture[str]) -> None:
    bench = start(LocalizationSlamToolbox, map_file_name=str(saved), map_start_pose=[1.3, -1.8, 0.0])
    poses = bench.stage.collect(PoseWithCovarianceStamped, "pose", 10)
    stand(bench, lambda: bool(bench.map_to_odom and poses))
    assert offset(bench) < 0.05
    assert poses[-1].header.frame_id == "map"
    covariance = np.array(poses[-1].pose.covariance).reshape(6, 6)
    assert 0.0 < covariance[0, 0] < 0.05
    bench.stage.step_until(lambda: bool(bench.maps))
    before = grid_array(bench.maps[-1]).copy()
    # A wrong guess is put right by hand.
    guess = PoseWithCovarianceStamped()
    guess.header.frame_id, guess.pose.pose = "map", pose_message((0.7, -2.4, 0.6))
    bench.stage.publish("initialpose", guess)
    bench.stage.step_for(0.2)
    del bench.map_to_odom[:]
    stand(bench, lambda: bool(bench.map_to_odom))
    assert offset(bench) < 0.05
    bench.stage.call(Empty, "/slam_toolbox/clear_localization_buffer")
    answer = bench.stage.call(SerializePoseGraph, "/slam_toolbox/serialize_map", filename=str(saved.parent / "other"))
    assert answer.result == answer.RESULT_FAILED_TO_WRITE_FILE
    bench.stage.call(DeserializePoseGraph, "/slam_toolbox/deserialize_map", filename=str(saved), match_type=1)
    guess.header.frame_id = "odom"
    bench.stage.publish("initialpose", guess)
    bench.stage.step_for(1.0)
    assert np.array_equal(grid_array(bench.stage.call(GetMap, "/slam_toolbox/dynamic_map").map), before)
    errors = capfd.readouterr().err
    assert "a node that localizes does not change its map" in errors
    assert "expected match_type 3 (LOCALIZE_AT_POSE) while localizing, found 1" in errors
    assert "expected a pose in 'map' on initialpose, found 'odom'" in errors


def test_a_map_is_saved_loaded_and_gone_on_from(start: Start, saved: Path, tmp_path: Path) -> None:
    bench = start(SynchronousSlamToolbox)
    answer = bench.stage.call(SerializePoseGraph, "/slam_toolbox/serialize_map", filename=str(tmp_path / "map"))
    assert answer.result == answer.RESULT_FAILED_TO_WRITE_FILE
    bench.stage.call(
        DeserializePoseGraph,
        "/slam_toolbox/deserialize_map",
        filename=str(saved),
        match_type=DeserializePoseGraph.Request.START_AT_GIVEN_POSE,
        initial_pose=Pose2D(x=0.8, y=-2.2, theta=0.5),
    )
    stand(bench, lambda: bool(bench.map_to_odom))
    assert offset(bench) < 0.05
    answer = bench.stage.call(SerializePoseGraph, "/slam_toolbox/serialize_map", filename=str(tmp_path / "map"))
    assert answer.result == answer.RESULT_SUCCESS
    assert sorted(path.name for path in tmp_path.glob("map*")) == ["map.data", "map.posegraph"]
    assert bench.stage.call(ClearQueue, "/slam_toolbox/clear_queue").status


_SAVING = """
import sys
from daidalos.mapping.pose_graph_file import load_pose_graph, save_pose_graph
graph = load_pose_graph(sys.argv[1])
while True:
    save_pose_graph(graph, sys.argv[2])
    print("saved", flush=True)
"""
"""A program that saves a map again and again."""


@pytest.mark.slow
def test_a_killed_node_goes_on_from_its_saved_map(start: Start, saved: Path, tmp_path: Path) -> None:
    stem = tmp_path / "map"
    with subprocess.Popen([sys.executable, "-c", _SAVING, str(saved), str(stem)], stdout=subprocess.PIPE) as saving:
        assert saving.stdout is not None
        for _ in range(3):
            assert saving.stdout.readline() == b"saved\n"
        saving.kill()  # while it saves once more
    before = len(load_pose_graph(stem).clouds)
    bench = start(SynchronousSlamToolbox, map_file_name=str(stem), map_start_pose=[0.8, -2.2, 0.5])
    stand(bench, lambda: bool(bench.map_to_odom))
    assert offset(bench) < 0.05
    assert bench.node.slam.key_count == before + 1
    answer = bench.stage.call(SerializePoseGraph, "/slam_toolbox/serialize_map", filename=str(stem))
    assert answer.result == answer.RESULT_SUCCESS
    assert sorted(path.name for path in tmp_path.glob("map*")) == ["map.data", "map.posegraph"]


def test_a_map_asked_for_while_the_algorithms_are_compiled_is_loaded_afterwards(
    start: Start, saved: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    compilation: Future = Future()
    monkeypatch.setattr("daidalos.nodes.slam_toolbox._slam_toolbox.warm_up_in_background", lambda *_: compilation)
    bench = start(SynchronousSlamToolbox)
    client = bench.stage.node.create_client(DeserializePoseGraph, "/slam_toolbox/deserialize_map")
    bench.stage.step_until(client.service_is_ready)
    answer = client.call_async(DeserializePoseGraph.Request(filename=str(saved), match_type=1))
    bench.stage.step_for(0.5)
    assert not answer.done()
    compilation.set_result(None)
    bench.stage.result(answer)
    assert bench.node.slam.key_count > 0


@pytest.mark.parametrize("content", [None, b"", b"nothing of ours"])
def test_a_file_that_cannot_be_read_fails_the_configuration(
    stage: Callable[[dict[str, Any]], Stage], tmp_path: Path, content: bytes | None, capfd: pytest.CaptureFixture[str]
) -> None:
    if content is not None:
        (tmp_path / "bad.posegraph").write_bytes(content)
    parameters = {**PARAMETERS["/slam_toolbox"], "map_file_name": str(tmp_path / "bad")}
    node = stage({"/slam_toolbox": parameters}).add(LocalizationSlamToolbox())
    assert node.trigger_configure() == TransitionCallbackReturn.FAILURE
    assert f"{tmp_path / 'bad.posegraph'}: " in capfd.readouterr().err
    assert node.current_state.label == "unconfigured"


def test_mapping_and_localization_change_over(start: Start, saved: Path) -> None:
    bench = start(
        MapAndLocalizationSlamToolbox,
        map_file_name=str(saved),
        map_start_pose=PLACE.tolist(),
        localization_on_configure=True,
    )
    stand(bench, lambda: bool(bench.map_to_odom))
    count = bench.node.slam.key_count
    assert bench.stage.call(SetBool, "/slam_toolbox/set_localization_mode", data=False).success
    for k in range(10):
        moved = np.array([0.1 * k, 0.0, 0.0])
        bench.look(pose2.compose(PLACE, moved), moved)
    bench.stage.step_until(lambda: bench.node.slam.key_count > count)
    assert offset(bench) < 0.05


def test_key_scans_are_moved_by_hand(start: Start, saved: Path) -> None:
    bench = start(SynchronousSlamToolbox, map_file_name=str(saved), map_start_pose=PLACE.tolist())
    graphs = bench.stage.collect(MarkerArray, "slam_toolbox/graph_visualization", 10)
    stand(bench, lambda: bool(bench.map_to_odom and graphs))
    slam = bench.node.slam
    spheres = [marker for marker in graphs[-1].markers if marker.ns == "slam_toolbox"]
    assert len(spheres) == slam.key_count
    bench.stage.call(ToggleInteractive, "/slam_toolbox/toggle_interactive_mode")
    assert bench.node.get_parameter("paused_processing").value
    moved = slam.key_count - 2
    wanted = pose2.compose(slam.key_pose(moved), (0.2, 0.1, 0.0))
    feedback = InteractiveMarkerFeedback(
        client_id="rviz",
        marker_name=str(moved),
        event_type=InteractiveMarkerFeedback.MOUSE_UP,
        pose=pose_message(wanted),
    )
    before = slam.key_pose(moved)
    bench.stage.publish("slam_toolbox/feedback", feedback)
    bench.stage.step_until(lambda: moved in bench.node._moved_scans.moved)
    bench.stage.call(Clear, "/slam_toolbox/clear_changes")
    bench.stage.call(LoopClosure, "/slam_toolbox/manual_loop_closure")
    assert slam.key_pose(moved) == pytest.approx(before)
    bench.stage.publish("slam_toolbox/feedback", feedback)
    bench.stage.step_until(lambda: moved in bench.node._moved_scans.moved)
    bench.stage.call(LoopClosure, "/slam_toolbox/manual_loop_closure")
    assert pose2.between(wanted, slam.key_pose(moved)) == pytest.approx(np.zeros(3), abs=0.1)
    bench.stage.call(ToggleInteractive, "/slam_toolbox/toggle_interactive_mode")
    assert not bench.node.get_parameter("paused_processing").value


def test_new_scans_are_paused(start: Start) -> None:
    bench = start(SynchronousSlamToolbox)
    assert bench.stage.call(Pause, "/slam_toolbox/pause_new_measurements").status
    for _ in range(20):
        bench.look(PLACE, np.zeros(3))
    assert bench.node.slam.key_count == 0
    assert bench.stage.call(Pause, "/slam_toolbox/pause_new_measurements").status
    stand(bench, lambda: bench.node.slam.key_count > 0)


def test_a_lifelong_map_keeps_what_it_needs(start: Start, saved: Path) -> None:
    bench = start(LifelongSlamToolbox, map_file_name=str(saved), map_start_pose=PLACE.tolist())
    stand(bench, lambda: bool(bench.map_to_odom))
    assert offset(bench) < 0.05


def test_two_maps_are_merged(stage: Callable[[dict[str, Any]], Stage], saved: Path) -> None:
    scene = stage({})
    scene.add(MergeMapsKinematic())
    maps, parts = scene.collect(OccupancyGrid, "map", LATCHED), scene.collect(OccupancyGrid, "map_2", LATCHED)
    for _ in range(2):
        scene.call(AddSubmap, "/slam_toolbox/add_submap", filename=str(saved))
    scene.step_until(lambda: bool(parts))
    place = InteractiveMarkerFeedback(
        client_id="rviz",
        marker_name="2",
        event_type=InteractiveMarkerFeedback.MOUSE_UP,
        pose=pose_message((20.0, 0, 0)),
    )
    scene.publish("merge_maps_tool/feedback", place)
    scene.step_for(0.3)
    scene.call(MergeMaps, "/slam_toolbox/merge_submaps")
    scene.step_until(lambda: bool(maps))
    assert maps[-1].info.width > parts[-1].info.width + 15.0 / 0.05
