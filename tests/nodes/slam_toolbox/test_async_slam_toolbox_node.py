"""The SLAM node, driven through a synthetic world by the test."""

from __future__ import annotations

import math
from array import array
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from nav_msgs.msg import MapMetaData, OccupancyGrid
from nav_msgs.srv import GetMap
from rclpy.lifecycle import TransitionCallbackReturn
from sensor_msgs.msg import LaserScan
from slam_toolbox.srv import Reset, SaveMap
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage

from daidalos.common.kernels import warm_up
from daidalos.mapping.evaluation import compare_with_truth
from daidalos.mapping.grid import OccupancyGrid as Grid
from daidalos.mapping.map_file import load_map
from daidalos.nodes.conversions import grid_array, pose2_of, transform_stamped, yaw_of
from daidalos.nodes.slam_toolbox.async_slam_toolbox_node import AsynchronousSlamToolbox
from mapping.worlds import Lidar, arena, drive, raster, wheel_odometry
from nodes.stepped import LATCHED, Stage

pytestmark = [pytest.mark.usefixtures("compiled"), pytest.mark.timeout(300)]

PARAMETERS: dict[str, Any] = {
    "/slam_toolbox": {
        "base_frame": "base_link",
        "scan_queue_size": 1000,
        "minimum_travel_distance": 0.2,
        "map_update_interval": 0.5,
    }
}
LIDAR = Lidar(beams=180, field=math.pi, pose=(0.1, 0.0, 0.2))
TOUR = np.array([[-3.0, -2.3], [3.0, -2.3], [3.2, 2.2], [-3.0, 2.3]])
RATE = 5.0


@pytest.fixture(scope="module")
def compiled() -> None:
    """Compile the kernels of mapping."""
    warm_up("daidalos.mapping")


class Bench:
    """The node on a stage, with a lidar on a robot whose odometry drifts."""

    def __init__(self, stage: Stage, make: Callable[[], Any] = AsynchronousSlamToolbox) -> None:
        self.stage = stage
        self.node = stage.add(make())
        assert self.node.trigger_configure() == TransitionCallbackReturn.SUCCESS
        assert self.node.trigger_activate() == TransitionCallbackReturn.SUCCESS
        self.maps = stage.collect(OccupancyGrid, "map", LATCHED)
        self.map_to_odom: list[Any] = []
        self._rng = np.random.default_rng(7)
        self._transforms = stage.node.create_publisher(TFMessage, "/tf", 100)
        self._scans = stage.node.create_publisher(LaserScan, "/scan", 100)
        stage.node.create_subscription(TFMessage, "/tf", self._on_transforms, 100)
        stage.publish("/tf_static", TFMessage(transforms=[self._transform(LIDAR.pose, "base_link", "laser")]), LATCHED)
        self.map_info = stage.collect(MapMetaData, "map_metadata", LATCHED)

    def _on_transforms(self, message: TFMessage) -> None:
        self.map_to_odom += [one for one in message.transforms if one.header.frame_id == "map"]

    def _transform(self, pose: Any, frame: str, child: str) -> Any:
        return transform_stamped(pose, frame, child, self.stage.stamp)

    def look(self, true: np.ndarray, odometry: np.ndarray, **changes: Any) -> None:
        """Take a step of the clock, and publish odometry and a scan of it; `changes` are those of the scan."""
        self.stage.step(1.0 / RATE)
        self._transforms.publish(TFMessage(transforms=[self._transform(odometry, "odom", "base_link")]))
        seen = LIDAR.scan(arena(), true, self._rng)
        scan = LaserScan(
            angle_min=seen.angle_min,
            angle_increment=seen.angle_increment,
            angle_max=-seen.angle_min,
            range_min=seen.range_min,
            range_max=seen.range_max,
            ranges=array("f", seen.ranges.tolist()),
        )
        scan.header.stamp, scan.header.frame_id = self.stage.stamp, "laser"
        for name, value in changes.items():
            setattr(scan, name, value)
        self._scans.publish(scan)

    def tour(self, corners: np.ndarray = TOUR) -> tuple[np.ndarray, np.ndarray]:
        """Drive from corner to corner; return the last true pose and the last one of the odometry, from the first."""
        true = drive(corners, speed=0.8, rate=RATE)
        odometry = wheel_odometry(true, np.random.default_rng(3), scale=0.02, noise=0.05)
        for pose, measured in zip(true, odometry, strict=True):
            self.look(pose, measured)
        return true[-1], odometry[-1]

    def believed(self, odometry: np.ndarray) -> np.ndarray:
        """Return where the latest map->odom puts the robot."""
        transform = self.map_to_odom[-1].transform
        yaw = yaw_of(transform.rotation)
        x, y = transform.translation.x, transform.translation.y
        cosine, sine = math.cos(yaw), math.sin(yaw)
        return np.array([x + cosine * odometry[0] - sine * odometry[1], y + sine * odometry[0] + cosine * odometry[1]])

    def wait_for_map(self) -> OccupancyGrid:
        """Look from one place until the first map comes."""
        while not self.maps:
            self.look(np.zeros(3), np.zeros(3))
        return self.maps[-1]


@pytest.fixture
def bench(stage: Callable[[dict[str, Any]], Stage]) -> Bench:
    return Bench(stage(PARAMETERS))


def grid_of(message: OccupancyGrid) -> Grid:
    x, y, yaw = (float(value) for value in pose2_of(message.info.origin))
    return Grid(grid_array(message), message.info.resolution, (x, y, yaw))


@pytest.mark.slow
def test_the_map_and_the_place_in_it(bench: Bench) -> None:
    true, odometry = bench.tour()
    assert np.hypot(*(odometry - true)[:2]) > 0.2
    bench.stage.step_until(lambda: np.hypot(*(bench.believed(odometry) - true[:2])) < 0.08)
    bench.stage.step_for(1.0)
    message = bench.stage.call(GetMap, "/slam_toolbox/dynamic_map").map
    agreement = compare_with_truth(grid_of(message), raster(arena(), message.info.resolution))
    assert agreement.walls_true > 0.95
    assert agreement.walls_found > 0.75
    assert message.header.frame_id == "map"
    assert message.info.resolution == pytest.approx(0.05)
    assert np.array_equal(grid_array(bench.maps[-1]), grid_array(message))
    assert bench.map_info[-1] == bench.maps[-1].info


def test_the_transform_is_stamped_ahead_and_comes_at_its_period(
    stage: Callable[[dict[str, Any]], Stage],
) -> None:
    values = {**PARAMETERS["/slam_toolbox"], "transform_publish_period": 0.1, "transform_timeout": 0.3}
    bench = Bench(stage({"/slam_toolbox": values}))
    bench.wait_for_map()
    del bench.map_to_odom[:]
    bench.stage.step_for(2.0)
    assert len(bench.map_to_odom) == pytest.approx(20, abs=1)
    last = bench.map_to_odom[-1]
    assert (last.header.frame_id, last.child_frame_id) == ("map", "odom")
    stamp = last.header.stamp.sec + 1e-9 * last.header.stamp.nanosec
    assert stamp == pytest.approx(bench.stage.now + 0.3, abs=0.11)


def test_frames_and_topics_are_parameters(stage: Callable[[dict[str, Any]], Stage]) -> None:
    values = {**PARAMETERS["/slam_toolbox"], "map_frame": "world", "scan_topic": "/front/scan", "resolution": 0.1}
    bench = Bench(stage({"/slam_toolbox": values}))
    bench._scans = bench.stage.node.create_publisher(LaserScan, "/front/scan", 100)
    message = bench.wait_for_map()
    assert message.header.frame_id == "world"
    assert message.info.resolution == pytest.approx(0.1)


def test_the_map_is_latched(bench: Bench) -> None:
    message = bench.wait_for_map()
    bench.stage.step_for(1.0)
    late = bench.stage.collect(OccupancyGrid, "map", LATCHED)
    bench.stage.step_until(lambda: bool(late))
    assert late[0].info.width == message.info.width


@pytest.mark.parametrize(
    "changes",
    [
        {"ranges": array("f", [])},
        {"ranges": array("f", [math.nan] * 180)},
        {"ranges": array("f", [math.inf] * 180)},
        {"ranges": array("f", [1.0] * 7)},
    ],
)
def test_a_scan_that_shows_nothing_does_no_harm(bench: Bench, changes: dict[str, Any]) -> None:
    bench.wait_for_map()
    for _ in range(3):
        bench.look(np.zeros(3), np.zeros(3), **changes)
    true, odometry = bench.tour(np.array([[0.0, 0.0], [1.0, 0.0]]))
    bench.stage.step_until(lambda: np.hypot(*(bench.believed(odometry) - true[:2])) < 0.05)
    message = bench.stage.call(GetMap, "/slam_toolbox/dynamic_map").map
    assert compare_with_truth(grid_of(message), raster(arena(), 0.05)).walls_true > 0.9


def test_a_sensor_without_a_transform_is_named_and_keeps_nobody_waiting(
    bench: Bench, capfd: pytest.CaptureFixture[str]
) -> None:
    for _ in range(3):
        header = LaserScan().header
        header.stamp, header.frame_id = bench.stage.stamp, "periscope"
        bench.look(np.zeros(3), np.zeros(3), header=header)
    bench.wait_for_map()
    text = capfd.readouterr().err
    assert "scans of 'periscope' are not used: waiting for the transform from periscope to base_link" in text
    assert text.count("periscope to base_link") == 1


@pytest.mark.slow
def test_a_base_that_is_named_wrongly_and_missing_odometry_are_reported(
    stage: Callable[[dict[str, Any]], Stage], capfd: pytest.CaptureFixture[str]
) -> None:
    values = {**PARAMETERS["/slam_toolbox"], "odom_frame": "odometry"}
    bench = Bench(stage({"/slam_toolbox": values}))
    reported = ""

    def names_odometry() -> bool:
        nonlocal reported
        bench.look(np.zeros(3), np.zeros(3))
        reported += capfd.readouterr().err
        return "wait for the transform odometry -> base_link" in reported

    bench.stage.step_until(names_odometry)
    assert bench.map_to_odom == []


def test_a_scan_without_measurements_is_reported(bench: Bench, capfd: pytest.CaptureFixture[str]) -> None:
    bench.wait_for_map()
    bench.look(np.zeros(3), np.zeros(3), ranges=array("f", [math.nan] * 180))
    reported = ""

    def names_reason() -> bool:
        nonlocal reported
        reported += capfd.readouterr().err
        return "a scan of 'laser': all its 180 ranges are NaN" in reported

    bench.stage.step_until(names_reason)


def test_parameters_without_effect_are_named_once_with_their_reason(
    stage: Callable[[dict[str, Any]], Stage], capfd: pytest.CaptureFixture[str]
) -> None:
    given = {
        "solver_plugin": "solver_plugins::CeresSolver",
        "stack_size_to_use": 40000000,
        "ceres_preconditioner": "JACOBI",
    }
    Bench(stage({"/slam_toolbox": {**PARAMETERS["/slam_toolbox"], **given}}))
    text = capfd.readouterr().err
    assert text.count("without effect") == 2
    assert "solver_plugin, ceres_preconditioner: poses are solved by a sparse Levenberg-Marquardt" in text
    assert "stack_size_to_use: files are written without recursion" in text


def test_the_map_is_saved(bench: Bench, tmp_path: Path) -> None:
    name = String(data=str(tmp_path / "arena"))
    assert bench.stage.call(SaveMap, "/slam_toolbox/save_map", name=name).result == (
        SaveMap.Response.RESULT_NO_MAP_RECEIEVD
    )
    bench.wait_for_map()
    assert bench.stage.call(SaveMap, "/slam_toolbox/save_map", name=name).result == SaveMap.Response.RESULT_SUCCESS
    message = bench.stage.call(GetMap, "/slam_toolbox/dynamic_map").map
    assert load_map(tmp_path / "arena.yaml").data.shape == (message.info.height, message.info.width)
    lost = String(data=str(tmp_path / "no such folder" / "arena"))
    answer = bench.stage.call(SaveMap, "/slam_toolbox/save_map", name=lost)
    assert answer.result == SaveMap.Response.RESULT_UNDEFINED_FAILURE


def test_a_reset_begins_a_new_map(bench: Bench) -> None:
    bench.tour(np.array([[-3.0, -2.3], [0.0, -2.3]]))
    bench.stage.step_until(lambda: bool(bench.maps))
    assert bench.stage.call(Reset, "/slam_toolbox/reset").result == Reset.Response.RESULT_SUCCESS
    assert bench.stage.call(GetMap, "/slam_toolbox/dynamic_map").map.info.width == 0
    bench.stage.step_for(0.5)
    del bench.map_to_odom[:], bench.maps[:]
    bench.stage.step_for(0.5)
    assert bench.map_to_odom == []
    bench.wait_for_map()
    bench.stage.step_until(lambda: bool(bench.map_to_odom))
    assert bench.believed(np.zeros(3)) == pytest.approx([0.0, 0.0], abs=0.02)


@pytest.mark.slow
def test_scans_can_be_throttled(stage: Callable[[dict[str, Any]], Stage]) -> None:
    bench = Bench(stage({"/slam_toolbox": {**PARAMETERS["/slam_toolbox"], "throttle_scans": 1000}}))
    for _ in range(50):
        bench.look(np.zeros(3), np.zeros(3))
    bench.stage.step_for(1.0)
    assert bench.map_to_odom == []
    assert bench.maps == []
