"""Failures of localization in a saved map while the robot drives, in lock-step."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from nav2_msgs.action import NavigateToPose
from nav2_msgs.srv import LoadMap

from daidalos.mapping.grid import OccupancyGrid
from daidalos.mapping.map_file import save_map
from daidalos.testing.programs import Nodes
from daidalos.testing.scenario import Scenario
from daidalos.testing.worlds import World
from description.robots import SHARE
from end_to_end.driving import BLIND_M, Drive

pytestmark = [
    pytest.mark.slow,
    pytest.mark.timeout(600),
    pytest.mark.skipif(os.name == "nt", reason="the scenarios end programs by signals"),
]

PARAMETERS = SHARE / "nav2_bringup/params/nav2_params.yaml"
ARENA = SHARE / "turtlebot3_gazebo/worlds/arena.world"
RESOLUTION = 0.05
LOW = (-5.0, -4.0)
"""Lower left corner of the map [m]."""


def map_of(world: Path) -> OccupancyGrid:
    """Return the map of a world of upright boxes and cylinders whose links stand where their models do."""
    x, y = np.meshgrid(*(low + (np.arange(-2.0 * low / RESOLUTION) + 0.5) * RESOLUTION for low in LOW))
    data = np.zeros(x.shape, dtype=np.int8)
    for model in ElementTree.parse(world).iter("model"):
        for collision in model.iter("collision"):
            places = [each.findtext("pose", "0 0 0").split()[:2] for each in (model, collision)]
            dx, dy = (
                abs(x - sum(float(place[0]) for place in places)),
                abs(y - sum(float(place[1]) for place in places)),
            )
            if collision.find("geometry/box") is not None:
                width, depth, _ = map(float, collision.findtext("geometry/box/size", "").split())
                data[(dx <= width / 2) & (dy <= depth / 2)] = 100
            elif collision.find("geometry/cylinder") is not None:
                data[np.hypot(dx, dy) <= float(collision.findtext("geometry/cylinder/radius", ""))] = 100
    return OccupancyGrid(data, RESOLUTION, (*LOW, 0.0))


@pytest.fixture
def drive(world: World, launch: Any, action: Any, clock: Scenario, transform: Any, tmp_path: Path) -> Drive:
    map_file, _ = save_map(map_of(ARENA), tmp_path / "arena")
    parameters = tmp_path / "params.yaml"
    parameters.write_text(
        PARAMETERS.read_text().replace("    base_frame_id:", "    set_initial_pose: true\n    base_frame_id:", 1)
    )
    launch("turtlebot3_gazebo", "turtlebot3_arena.launch.py")
    given = {"use_sim_time": True, "params_file": str(parameters)}
    launch("nav2_bringup", "localization_launch.py", map=str(map_file), **given)
    launch("nav2_bringup", "navigation_launch.py", **given)
    robot = world.wait_for("waffle")
    robot.never_touches()
    transform("map", "base_link").wait(60.0)
    driven = Drive(robot, action("/navigate_to_pose", NavigateToPose), clock)
    driven.start()
    return driven


@pytest.mark.scenario(timeout=120, seed=1)
def test_a_goal_is_reached_in_a_saved_map(drive: Drive) -> None:
    assert drive.end() == ""


@pytest.mark.scenario(timeout=120, seed=1)
def test_localization_that_is_killed(drive: Drive, nodes: Nodes) -> None:
    nodes["amcl"].kill()
    assert drive.distance_in(4.0) < BLIND_M
    assert "the transform from map to odom" in drive.end()


@pytest.mark.scenario(timeout=120, seed=1)
@pytest.mark.parametrize("pose", [(-1.5, -1.5, 2.0), (-2.0, 0.0, 3.1)])
def test_a_robot_that_is_carried_away_does_not_report_success(drive: Drive, pose: tuple[float, float, float]) -> None:
    drive.robot.move(pose[0], pose[1], yaw=pose[2])
    assert drive.distance_in(4.0) < 0.5
    assert "was aborted" in drive.end()


@pytest.mark.scenario(timeout=120, seed=1)
def test_a_map_that_is_changed_shows_the_way(drive: Drive, service: Any, tmp_path: Path) -> None:
    """A wall of the new map bars the way, though there is none in the world: the robot drives around it."""
    changed = map_of(ARENA)
    column, low, high = (
        round((value - corner) / RESOLUTION) for value, corner in ((1.2, LOW[0]), (-0.9, LOW[1]), (0.9, LOW[1]))
    )
    changed.data[low:high, column : column + 2] = 100
    file, _ = save_map(changed, tmp_path / "changed")
    assert service("/map_server/load_map", LoadMap).call(map_url=str(file)).result == 0
    drive.robot.pose.always(lambda pose: not (1.15 < pose.x < 1.35 and abs(pose.y) < 0.85))
    assert drive.end() == ""


@pytest.mark.scenario(timeout=120, seed=1)
def test_a_map_of_another_place_stops_the_robot(drive: Drive, service: Any, tmp_path: Path) -> None:
    other = map_of(ARENA)
    other.data[:] = 0
    for row, column in np.random.default_rng(1).integers(0, other.data.shape, (60, 2)):
        other.data[row : row + 4, column : column + 4] = 100
    file, _ = save_map(other, tmp_path / "other")
    assert service("/map_server/load_map", LoadMap).call(map_url=str(file)).result == 0
    assert "was aborted" in drive.end()
    assert "the transform from map to odom" in drive.failure or "base_footprint to map" in drive.failure
