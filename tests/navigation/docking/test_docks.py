"""Types of docks, their detection, and their database."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from daidalos.common.parameters import ParameterError, parameters_from
from daidalos.common.pose3 import Pose, quaternion_from_rpy
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.docking.approach import ApproachParameters, obstacle_on, projected_path
from daidalos.navigation.docking.database import read_docks
from daidalos.navigation.docking.docks.simple_docks import SimpleChargingDock, SimpleNonChargingDock
from daidalos.navigation.errors import DockNotValid, FailedToDetectDock

FLAT = {
    "use_external_detection_pose": True, "external_detection_rotation_pitch": 0.0,
    "external_detection_rotation_roll": 0.0, "external_detection_translation_x": -0.2, "filter_coef": 0.5,
}  # fmt: skip


def dock(kind: Any = SimpleNonChargingDock, **values: Any) -> Any:
    return kind(parameters_from(kind.Parameters, values))


def seen(x: float, y: float, yaw: float = 0.0) -> Pose:
    return Pose((x, y, 0.0), quaternion_from_rpy(0.0, 0.0, yaw))


def test_a_dock_that_is_seen_is_filtered_and_must_be_recent() -> None:
    one = dock(**FLAT)
    with pytest.raises(FailedToDetectDock, match="no pose has come"):
        one.refined_pose(np.zeros(3), 0.0)
    one.take_detection(seen(2.0, 0.0), 10.0)
    assert one.refined_pose(np.zeros(3), 10.5) == pytest.approx([1.8, 0.0, 0.0])
    one.take_detection(seen(2.2, 0.1), 10.5)
    assert one.refined_pose(np.zeros(3), 10.5) == pytest.approx([1.9, 0.05, 0.0])
    assert one.is_docked(np.array([1.87, 0.05, 0.0]))
    with pytest.raises(FailedToDetectDock, match=r"last seen 1\.5 s ago, the limit is 1 s"):
        one.refined_pose(np.zeros(3), 12.0)
    with pytest.raises(FailedToDetectDock, match="ahead of the clock"):
        one.refined_pose(np.zeros(3), 5.0)


def test_poses_that_jump_or_are_not_finite_are_not_believed() -> None:
    one = dock(**FLAT)
    one.take_detection(seen(2.0, 0.0), 10.0)
    one.take_detection(seen(4.0, 0.0), 10.1)
    assert one.refined_pose(np.zeros(3), 10.9) == pytest.approx([1.8, 0.0, 0.0])
    one.take_detection(seen(math.nan, 0.0), 10.9)
    with pytest.raises(FailedToDetectDock, match="not finite"):
        one.refined_pose(np.zeros(3), 11.5)
    one.take_detection(seen(4.0, 0.0), 11.4)  # nothing else came since: the filter begins anew
    assert one.refined_pose(np.zeros(3), 11.5) == pytest.approx([3.8, 0.0, 0.0])


def test_a_marker_of_a_camera_is_turned_to_the_dock() -> None:
    """A marker whose z axis looks at the robot and whose x axis looks to the right, with Nav2's default rotation."""
    one = dock(use_external_detection_pose=True, filter_coef=0.0)
    toward_robot = Pose((2.0, 0.0, 0.3), quaternion_from_rpy(math.pi / 2, 0.0, -math.pi / 2))
    one.take_detection(toward_robot, 1.0)
    assert one.refined_pose(np.zeros(3), 1.0) == pytest.approx([1.8, 0.0, 0.0], abs=2e-3)


def test_staging_stalls_and_charging() -> None:
    one = dock(staging_x_offset=-1.0, staging_yaw_offset=0.5)
    assert one.staging_pose(np.array([1.0, 2.0, math.pi / 2])) == pytest.approx([1.0, 1.0, math.pi / 2 + 0.5])
    stalling = dock(use_stall_detection=True, stall_joint_names=["left", "right"])
    stalling.take_joints(["left", "right", "arm"], [0.1, -0.3, 9.0], [3.0, -2.0, 0.0])
    assert stalling.is_docked(np.zeros(3))
    stalling.take_joints(["left", "right"], [0.1, 3.0], [3.0, 2.0])
    assert not stalling.is_docked(np.zeros(3))
    stalling.take_joints(["left", "right"], [], [])
    assert not stalling.is_docked(np.zeros(3))
    charging = dock(SimpleChargingDock)
    charging.start(np.zeros(3))
    assert charging.is_docked(np.zeros(3))
    assert not charging.is_charging(np.zeros(3))
    charging.take_battery(0.6)
    assert charging.is_charging(np.ones(3))
    assert dock(SimpleChargingDock, use_battery_status=False).is_charging(np.zeros(3)) is False


@pytest.mark.parametrize(
    ("values", "problem"),
    [
        ({"dock_direction": "left"}, "must be one of forward, backward, got 'left'"),
        ({"rotate_to_dock": True}, "needs the dock_direction backward"),
        ({"use_stall_detection": True}, "must not be empty with use_stall_detection"),
    ],
)
def test_parameters_that_do_not_fit_are_refused(values: Any, problem: str) -> None:
    with pytest.raises(ParameterError, match=problem):
        dock(**values)


def test_a_database_is_read(tmp_path: Path) -> None:
    path = tmp_path / "docks.yaml"
    path.write_text(
        "docks:\n  home:\n    type: a\n    pose: [1, 2.5, 0]\n  far: {type: b, frame: hall, pose: [0, 0, 0], id: '7'}\n"
    )
    docks = read_docks(path)
    assert (docks["home"].type, docks["home"].frame, docks["home"].pose) == ("a", "map", (1.0, 2.5, 0.0))
    assert (docks["far"].frame, docks["far"].id) == ("hall", "7")


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("docks:\n  home: [", "docks.yaml:2: "),
        ("dock: {}", "has no mapping 'docks'"),
        ("docks: {home: 5}", "the dock 'home' is 5, expected a mapping"),
        ("docks: {home: {type: a}}", "the dock 'home' has no 'pose'"),
        ("docks: {home: {type: a, pose: [1, 2]}}", "must have 3 elements"),
        ("docks: {home: {type: a, pose: [1, 2, x]}}", "must be a list of floats"),
        ("docks: {home: {type: a, pose: [1, 2, 3], fame: map}}", "did you mean 'frame'"),
    ],
)
def test_a_database_that_cannot_be_used_is_refused(tmp_path: Path, text: str, problem: str) -> None:
    path = tmp_path / "docks.yaml"
    path.write_text(text)
    with pytest.raises(DockNotValid) as caught:
        read_docks(path)
    assert problem in str(caught.value)
    assert "\n" not in str(caught.value)
    with pytest.raises(DockNotValid, match="cannot be read"):
        read_docks(tmp_path / "none.yaml")


def test_obstacles_on_the_way_are_found_and_the_dock_is_none() -> None:
    costmap, target = Costmap.filled(80, 80, 0.05, (-1.0, -2.0)), np.array([2.0, 0.0, 0.0])
    path = projected_path(ApproachParameters(projection_time=10.0), np.zeros(3), target, backward=False)
    assert path[-1, 0] > 1.8
    footprint = Footprint.circle(0.1)
    assert obstacle_on(path, costmap, footprint, target, 0.3) is None
    costmap.costs[38:42, 59:61] = 254  # at x = 2
    assert obstacle_on(path, costmap, footprint, target, 0.3) is None
    costmap.costs[38:42, 40] = 254  # at x = 1
    hit = obstacle_on(path, costmap, footprint, target, 0.3)
    assert hit is not None
    assert 0.8 < hit[0] < 1.1
