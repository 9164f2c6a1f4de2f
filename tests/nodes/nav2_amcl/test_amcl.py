"""AMCL's managed node, with a robot that wanders through a flat world."""

from __future__ import annotations

import math
from array import array
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from geometry_msgs.msg import PoseArray
from lifecycle_msgs.srv import GetState
from nav2_msgs.msg import ParticleCloud
from nav2_msgs.srv import SetInitialPose
from rcl_interfaces.msg import Log
from rclpy.lifecycle import TransitionCallbackReturn
from rclpy.parameter import Parameter
from rclpy.qos import qos_profile_sensor_data
from std_srvs.srv import Empty

from daidalos.mapping.grid import OccupancyGrid
from daidalos.nodes.nav2_amcl.amcl import AmclNode
from nodes.localizing import MAP, START, Walk, compiled
from nodes.stepped import Stage

__all__ = ["compiled"]
pytestmark = [pytest.mark.usefixtures("compiled"), pytest.mark.timeout(300)]
Set = Callable[[dict[str, Any]], Stage]


class Bench(Walk):
    """The node, configured, with its log."""

    def __init__(self, set_stage: Set, **parameters: Any) -> None:
        stage = set_stage({"/amcl": {"random_seed": 1, **parameters}})
        self.log = stage.collect(Log, "/rosout", 100)
        self.node = stage.add(AmclNode())
        super().__init__(stage)
        assert self.node.trigger_configure() == TransitionCallbackReturn.SUCCESS

    def activate(self) -> Bench:
        self.node.trigger_activate()
        self.stage.step()
        return self

    def warnings(self, word: str) -> list[Log]:
        return [one for one in self.log if word in one.msg]

    def wait_for(self, word: str) -> None:
        """Look until the log has a word."""
        self.stage.step_until(lambda: bool(self.warnings(word)))


@pytest.fixture
def localized(stage: Set) -> Bench:
    """A node that knows where the robot is."""
    bench = Bench(stage, updates_after_initial_pose=2).activate()
    bench.publish_map()
    bench.guess(START)
    for _ in range(4):
        bench.look()
    assert bench.error()[0] < 0.1
    return bench


@pytest.mark.slow
def test_a_robot_is_followed_from_a_guess_aside(stage: Set) -> None:
    bench = Bench(stage, max_particles=700)
    clouds = bench.stage.collect(ParticleCloud, "particle_cloud", qos_profile_sensor_data)
    arrays = bench.stage.collect(PoseArray, "particlecloud")
    bench.publish_map()
    bench.look()
    assert not bench.map_to_odom
    bench.activate()
    bench.look()
    assert not bench.poses
    assert bench.warnings("Please set the initial pose")
    bench.guess(START + np.array([0.4, -0.3, 0.25]))
    for _ in range(6):
        bench.look()
    assert bench.error()[0] < 0.08
    errors = []
    for _ in range(40):
        bench.walk(1)
        errors.append(bench.error())
    assert np.mean(errors, axis=0)[0] < 0.05
    pose = bench.poses[-1]
    assert pose.header.frame_id == "map"
    covariance = np.array(pose.pose.covariance).reshape(6, 6)
    assert np.allclose(covariance, covariance.T)
    assert 0.0 < covariance[0, 0] < 0.2
    assert 0.0 < covariance[5, 5] < 0.2
    assert len(clouds[-1].particles) == len(arrays[-1].poses) >= 500
    assert sum(one.weight for one in clouds[-1].particles) == pytest.approx(1.0)
    sent = bench.map_to_odom[-1]
    assert (sent.child_frame_id, sent.header.stamp.sec) == ("odom", bench.stage.stamp.sec + 1)


@pytest.mark.slow
def test_global_localization_and_recovery_after_being_carried(stage: Set) -> None:
    bench = Bench(stage, recovery_alpha_slow=0.001, recovery_alpha_fast=0.1, tf_broadcast=True).activate()
    bench.publish_map()
    bench.stage.call(Empty, "reinitialize_global_localization")
    for _ in range(250):
        bench.walk(1)
        if bench.map_to_odom and bench.error()[0] < 0.1 and bench.poses[-1].pose.covariance[0] < 0.1:
            break
    assert bench.error()[0] < 0.1
    bench.carry((6.5, 3.8, 2.0))
    for _ in range(400):
        bench.walk(1)
        if bench.error()[0] < 0.1:
            break
    assert bench.error()[0] < 0.1


def test_a_robot_moved_while_the_node_is_off_is_found_again(localized: Bench) -> None:
    bench = localized
    bench.node.trigger_deactivate()
    bench.carry((6.5, 3.8, 2.0))
    count = len(bench.map_to_odom)
    bench.look()
    assert len(bench.map_to_odom) == count
    bench.activate()
    bench.look()
    assert bench.error()[0] > 3.0
    bench.guess((6.3, 4.1, 1.8))
    for _ in range(6):
        bench.look()
    assert bench.error()[0] < 0.1


def test_services_and_parameters_at_run_time(localized: Bench) -> None:
    bench = localized
    updates = len(bench.poses)
    bench.look()
    assert len(bench.poses) == updates
    bench.stage.call(Empty, "request_nomotion_update")
    bench.look()
    assert len(bench.poses) == updates + 1
    request = bench.poses[-1]
    request.pose.pose.position.x += 0.2
    bench.stage.call(SetInitialPose, "set_initial_pose", pose=request)
    bench.look()
    assert len(bench.poses) == updates + 2
    changed = bench.node.set_parameters(
        [Parameter("max_beams", value=30), Parameter("tf_broadcast", value=False), Parameter("scan_topic", value="s2")]
    )
    assert all(one.successful for one in changed)
    count = len(bench.map_to_odom)
    bench.look()
    bench.stage.step_for(2.0)
    assert len(bench.map_to_odom) == count
    refused = bench.node.set_parameters([Parameter("min_particles", value=5000)])[0]
    assert not refused.successful
    assert "max_particles" in refused.reason
    assert bench.stage.call(GetState, "amcl/get_state").current_state.label == "active"


@pytest.mark.parametrize("forgets", [False, True])
def test_the_pose_outlives_a_new_configuration(stage: Set, forgets: bool) -> None:
    bench = Bench(stage, always_reset_initial_pose=forgets, map_topic="floor").activate()
    bench.node.set_parameters([Parameter("map_topic", value="map")])
    bench.publish_map()
    bench.guess(START)
    bench.look()
    bench.node.trigger_deactivate()
    bench.node.trigger_cleanup()
    del bench.poses[:]
    bench.node.trigger_configure()
    bench.activate()
    bench.publish_map()
    bench.look()
    bench.look()
    assert bool(bench.poses) is not forgets


def test_initial_poses_of_parameters_and_files(stage: Set, tmp_path: Path) -> None:
    file = tmp_path / "folder" / "pose"
    values = {"initialize_at_saved_pose": True, "saved_pose_filepath": str(file), "save_pose_rate": 5.0}
    bench = Bench(
        stage, set_initial_pose=True, service_introspection_mode="disabled", **values,
        **{f"initial_pose.{name}": float(value) for name, value in zip(("x", "y", "yaw"), START, strict=True)},
    ).activate()  # fmt: skip
    assert bench.warnings("without effect: service_introspection_mode")
    bench.publish_map()
    for _ in range(4):
        bench.look()
    assert bench.error()[0] < 0.1
    bench.stage.step_until(file.exists)
    bench.node.trigger_deactivate()
    bench.node.trigger_cleanup()
    assert bench.node.get_parameter("initial_pose.x").value == pytest.approx(bench.published()[0])
    bench.node.set_parameters([Parameter("set_initial_pose", value=False)])
    bench.node.trigger_configure()
    bench.activate()
    bench.publish_map()
    for _ in range(4):
        bench.look()
    assert bench.error()[0] < 0.1
    bench.node.trigger_deactivate()
    file.write_text("x: [")
    bench.activate()
    assert bench.warnings(f"there is no initial pose: {file}")


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"ranges": array("f", [math.nan] * 180)}, "all its 180 ranges are NaN"),
        ({"ranges": array("f", [math.inf] * 180)}, "all its 180 ranges are infinite"),
        ({"ranges": array("f")}, "it has no ranges"),
        ({"angle_min": math.nan}, "its angle_min is nan"),
        ({"range_max": 0.0}, "is not below its range_max (0)"),
    ],
)
def test_scans_that_say_nothing_are_reported_and_ignored(localized: Bench, changes: dict[str, Any], words: str) -> None:
    bench = localized
    for _ in range(5):
        bench.look(**changes)
    assert len(bench.warnings(words)) == 1
    bench.walk(3)
    assert bench.error()[0] < 0.15


def test_missing_transforms_and_scans_are_reported(localized: Bench) -> None:
    bench = localized
    scan = {"header": type(bench.poses[-1].header)(frame_id="camera", stamp=bench.stage.stamp)}
    for _ in range(5):
        bench.look(**scan)
    assert len(bench.warnings("waiting for the transform from camera to base_footprint")) == 1
    bench.look(with_odometry=False)
    bench.wait_for("waiting for its odometry")
    bench.look()
    bench.wait_for("no scan comes on '/scan', which has 1 publishers")
    bench.look()
    bench.look()
    assert bench.error()[0] < 0.1


@pytest.mark.slow
def test_time_that_goes_back_and_odometry_that_starts_anew(localized: Bench) -> None:
    bench = localized
    bench.walk(15)
    bench.odometry = np.zeros(3)
    bench.wanderer.odom = bench.odometry
    bench.odometry = np.array([30.0, 0.0, 0.0])
    bench.wanderer.odom = bench.odometry
    for _ in range(10):
        bench.look()
    assert bench.warnings("odometry jumped by")
    assert bench.error()[0] < 0.15
    bench.stage._now_ns -= 50_000_000_000
    for _ in range(10):
        bench.look()
    bench.wait_for("time went back")
    for _ in range(5):
        bench.look()
    assert bench.error()[0] < 0.15


def test_initial_poses_that_cannot_be_are_refused(localized: Bench) -> None:
    bench = localized
    bench.guess(START, frame="odom")
    bench.guess((math.nan, 0.0, 0.0))
    bench.guess((100.0, 0.0, 0.0))
    for words in ("in the frame 'odom' is ignored", "is not finite", "outside of the map"):
        assert bench.warnings(words)
    bench.look()
    assert bench.error()[0] < 0.1
    bench.guess(START, covariance=(-1.0, 0.25, 0.07))
    assert bench.warnings("is not positive")
    bench.guess(START, covariance=(0.0, 0.0, 0.0))
    for _ in range(4):
        bench.look()
    assert bench.error()[0] < 0.1


def test_maps_that_are_broken_or_replaced(localized: Bench) -> None:
    bench = localized
    bench.publish_map(OccupancyGrid(np.zeros((4, 4), np.int8), 0.05, (0.0, 0.0, 0.0)))
    assert bench.warnings("a map is not used: the map has no obstacle")
    bench.look()
    assert bench.error()[0] < 0.1
    height, width = (size // 2 * 2 for size in MAP.data.shape)
    halves = [MAP.data[i:height:2, j:width:2] for i in (0, 1) for j in (0, 1)]
    bench.publish_map(OccupancyGrid(np.maximum.reduce(halves), 2.0 * MAP.resolution, MAP.origin), frame="world")
    assert bench.warnings("not in global_frame_id 'map'")
    for _ in range(6):
        bench.look()
    assert bench.error()[0] < 0.15
    bench.node.set_parameters([Parameter("first_map_only", value=True)])
    received = len(bench.warnings("Received a"))
    bench.publish_map()
    assert len(bench.warnings("Received a")) == received
