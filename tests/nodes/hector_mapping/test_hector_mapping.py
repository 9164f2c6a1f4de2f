"""`hector_mapping` with the parameters of a course's launch file, with and without odometry."""

from __future__ import annotations

from array import array
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from nav_msgs.msg import MapMetaData, OccupancyGrid, Odometry
from nav_msgs.srv import GetMap
from rcl_interfaces.msg import Log
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String
from std_srvs.srv import SetBool, Trigger
from tf2_msgs.msg import TFMessage

from daidalos.common.kernels import warm_up
from daidalos.common.pose2 import between, compose
from daidalos.nodes.conversions import grid_array, pose2_of, pose2_of_transform, pose_message, transform_stamped
from daidalos.nodes.hector_mapping.hector_mapping import HectorMapping
from mapping.worlds import Lidar, arena
from nodes.stepped import LATCHED, Stage

pytestmark = pytest.mark.timeout(300)
COURSE = {
    "map_frame": "map", "base_frame": "base_link", "odom_frame": "odom", "scan_topic": "scan",
    "use_tf_scan_transformation": True, "use_tf_pose_start_estimate": False, "pub_map_odom_transform": True,
    "map_resolution": 0.025, "map_size": 1024, "map_start_x": 0.5, "map_start_y": 0.5, "map_multi_res_levels": 4,
    "update_factor_free": 0.4, "update_factor_occupied": 0.9, "map_update_distance_thresh": 0.4,
    "map_update_angle_thresh": 0.06, "map_pub_period": 2.0, "advertise_map_service": False,
}  # fmt: skip
BEGIN = np.array([-3.0, -2.0, 0.0])
ODOMETRY_ERROR = np.array([0.5, -0.2, 0.4])
MOUNT = (-0.064, 0.0, 0.0)


@pytest.fixture(scope="module", autouse=True)
def compiled() -> None:
    warm_up("daidalos.mapping.hector")


class Look:
    """A robot in the arena, its scans and odometry, and what the node publishes."""

    def __init__(self, stage: Stage, *, has_mount: bool = True) -> None:
        self.stage = stage
        self.pose = BEGIN.copy()
        self.lidar = Lidar(beams=180, field=2.0 * np.pi * 179 / 180, noise=0.0, pose=MOUNT)
        self.poses = stage.collect(PoseStamped, "slam_out_pose")
        self.updates = stage.collect(PoseWithCovarianceStamped, "poseupdate")
        self.log = stage.collect(Log, "/rosout", 100)
        self.transforms: list[Any] = []
        self._tf = stage.node.create_publisher(TFMessage, "/tf", 100)
        self._scans = stage.node.create_publisher(LaserScan, "scan", 10)
        stage.node.create_subscription(TFMessage, "/tf", lambda one: self.transforms.extend(one.transforms), 100)
        if has_mount:
            mount = transform_stamped(MOUNT, "base_link", "laser", stage.stamp)
            stage.publish("/tf_static", TFMessage(transforms=[mount]), LATCHED)
        stage.add(HectorMapping())
        stage.step_until(lambda: self.said("ready for scans"))

    def look(self, *, with_odometry: bool = False, **changes: Any) -> None:
        """Publish a scan at a new time; `changes` are those of the message."""
        self.stage.step(0.1)
        if with_odometry:
            odometry = compose(ODOMETRY_ERROR, between(BEGIN, self.pose))
            moved = transform_stamped(odometry, "odom", "base_link", self.stage.stamp)
            self._tf.publish(TFMessage(transforms=[moved]))
        seen = self.lidar.scan(arena(), self.pose, np.random.default_rng(0))
        scan = LaserScan(
            angle_min=seen.angle_min, angle_increment=seen.angle_increment, range_min=seen.range_min,
            range_max=seen.range_max, ranges=array("f", np.asarray(seen.ranges).tolist()),
        )  # fmt: skip
        scan.header.stamp, scan.header.frame_id = self.stage.stamp, "laser"
        for name, value in changes.items():
            setattr(scan, name, value)
        self._scans.publish(scan)
        self.stage.step(0.02)

    def drive(self, steps: int, **options: Any) -> None:
        """Drive on to the right, with a scan at each step."""
        for _ in range(steps):
            self.pose = self.pose + np.array([0.1, 0.0, 0.0])
            self.look(**options)

    def said(self, text: str) -> bool:
        """Return whether the log has a text."""
        return any(text in one.msg for one in self.log)

    def error(self) -> float:
        """Return how far off the last pose is [m]."""
        away = between(between(BEGIN, self.pose), pose2_of(self.poses[-1].pose))
        return float(np.hypot(*away[:2]))

    def of(self, child: str) -> list[Any]:
        """Return the transforms of a frame."""
        return [one for one in self.transforms if one.child_frame_id == child]


def test_the_courses_parameters_map_without_odometry(stage: Callable[[dict[str, Any]], Stage]) -> None:
    set_stage = stage({"/hector_mapping": {**COURSE, "pub_odometry": True, "pub_drawings": False}})
    robot_log = set_stage.collect(Odometry, "scanmatch_odom")
    maps = set_stage.collect(OccupancyGrid, "map", LATCHED)
    sizes = set_stage.collect(MapMetaData, "map_metadata", LATCHED)
    log = set_stage.collect(Log, "/rosout", 100)
    robot = Look(set_stage)
    robot.look()
    robot.drive(15)
    assert robot.error() < 0.03
    assert len(robot.poses) == len(robot.updates) == len(robot_log) == 16
    covariance = np.array(robot.updates[-1].pose.covariance).reshape(6, 6)
    assert 0.0 < covariance[0, 0] < 0.01
    assert 0.0 < covariance[5, 5] < 0.01
    assert between(pose2_of(robot.poses[-1].pose), pose2_of_transform(robot.of("scanmatcher_frame")[-1].transform)) == (
        pytest.approx(0.0, abs=1e-9)
    )
    assert not robot.of("odom")
    set_stage.step_until(lambda: len(maps) > 0 and len(sizes) > 0)
    assert (sizes[-1].width, sizes[-1].height, round(sizes[-1].resolution, 4)) == (1024, 1024, 0.025)
    assert (grid_array(maps[-1]) == 100).sum() > 100
    assert any("without effect: pub_drawings" in one.msg for one in log)
    robot.stage.step_until(lambda: robot.said("map -> odom is not published") or robot.look())


def test_the_transform_to_odometry_follows_the_matches(stage: Callable[[dict[str, Any]], Stage]) -> None:
    set_stage = stage({"/hector_mapping": COURSE})
    robot = Look(set_stage)
    robot.look(with_odometry=True)
    robot.drive(8, with_odometry=True)
    set_stage.step_until(lambda: len(robot.of("odom")) >= 8)
    expected = between(ODOMETRY_ERROR, np.zeros(3))
    assert between(expected, pose2_of_transform(robot.of("odom")[-1].transform)) == pytest.approx(0.0, abs=0.03)


def test_commands_and_services(stage: Callable[[dict[str, Any]], Stage]) -> None:
    set_stage = stage({"/hector_mapping": {"map_size": 512}})
    robot = Look(set_stage)
    robot.look()
    assert (grid_array(set_stage.call(GetMap, "dynamic_map").map) == 100).any()
    assert set_stage.call(SetBool, "pause_mapping", data=True).success
    robot.look()
    assert len(robot.poses) == 1
    assert set_stage.call(SetBool, "pause_mapping", data=False).success
    assert set_stage.call(Trigger, "reset_map").success
    assert (grid_array(set_stage.call(GetMap, "dynamic_map").map) == -1).all()
    guess = PoseWithCovarianceStamped()
    guess.header.frame_id, guess.pose.pose = "map", pose_message((1.0, 0.5, 0.3))
    set_stage.publish("initialpose", guess)
    set_stage.step_until(lambda: robot.said("is looked for at 1.000 0.500 0.300"))
    robot.look()
    assert pose2_of(robot.poses[-1].pose) == pytest.approx([1.0, 0.5, 0.3])
    guess.header.frame_id = "elsewhere"
    set_stage.publish("initialpose", guess)
    set_stage.step_until(lambda: robot.said("an initial pose in the frame 'elsewhere' is ignored"))
    set_stage.publish("syscommand", String(data="reset"))
    set_stage.step_until(lambda: sum("the map was reset" in one.msg for one in robot.log) == 2)
    assert (grid_array(set_stage.call(GetMap, "dynamic_map").map) == -1).all()


def test_scans_that_cannot_be_used_are_reported(stage: Callable[[dict[str, Any]], Stage]) -> None:
    set_stage = stage({"/hector_mapping": {"map_size": 512}})
    robot = Look(set_stage, has_mount=False)
    robot.look()
    set_stage.step_until(lambda: robot.said("there is no frame 'laser'"))
    mount = transform_stamped(MOUNT, "base_link", "laser", set_stage.stamp)
    set_stage.publish("/tf_static", TFMessage(transforms=[mount]), LATCHED)
    set_stage.step_until(lambda: bool(robot.poses) or robot.look())
    before = grid_array(set_stage.call(GetMap, "dynamic_map").map)
    for value, text in ((np.nan, "are NaN"), (np.inf, "are infinite")):
        robot.look(ranges=array("f", [value] * 180))
        set_stage.step_until(lambda text=text: robot.said(text))
    robot.look(ranges=array("f"))
    set_stage.step_until(lambda: robot.said("it has no ranges"))
    assert np.array_equal(grid_array(set_stage.call(GetMap, "dynamic_map").map), before)
    count = len(robot.poses)
    late = LaserScan().header
    late.frame_id, late.stamp = "laser", set_stage.stamp
    late.stamp.sec -= 1
    late.stamp.nanosec = 999_999_999
    robot.look(header=late)
    assert len(robot.poses) == count
    late.stamp.sec -= 50
    robot.look(header=late)
    set_stage.step_until(lambda: robot.said("time went back by"))
    robot.look()
    assert len(robot.poses) > count
    assert robot.error() < 0.03
    set_stage.step_until(lambda: robot.said("no scan comes on '/scan', which has 1 publishers"))
